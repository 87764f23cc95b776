// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drawings.h"
#include "formats/command.h"
#include "formats/scene.h"
#include "picture_error.h"
#include "renderer/cpu/light_guides.h"
#include "renderer/host/bvh.h"
#include "renderer/host/environment_map.h"
#include "renderer/host/host_scene.h"
#include "spectral_lines.h"

namespace opal {

/// One scene with some settings in memory, drawn in the precision that this program computes in.
class Subject : public Drawings {
  public:
    /// `settings`: overrides of the scene.
    Subject(const std::filesystem::path& scene, const std::vector<std::string>& settings, SpectralChoice spectral,
            Tracing tracing = Tracing::embree);

    /// The pixels whose centre shows a transparent body.
    std::vector<std::uint32_t> pixels() const { return gem_pixels(host_.view(), intersector_); }
    std::size_t memory_bytes() const override;
    double load_s() const override { return load_s_; }
    int width() const { return host_.view().width; }

    void draw(const std::vector<std::uint32_t>& pixels, int samples, std::uint64_t seed,
              Lighting lighting = Lighting::of_the_scene) override;

  private:
    template <int N>
    void draw_lanes(const std::vector<std::uint32_t>& pixels, int samples, std::uint64_t seed, Lighting lighting);
    template <int N, class Intersector>
    Opponent mean_of_pixel(const SceneView& view, const Intersector& intersector, std::uint32_t pixel, int samples) const;

    const Stopwatch watch_;
    std::vector<std::string> notices_;
    const SceneDescription description_;
    const HostScene host_;
    const EmbreeScene intersector_;
    const std::optional<Bvh> tree_;  ///< where it finds the surfaces
    const LightGuides guides_;
    const SpectralLines lines_;
    const double load_s_;
    const EnvironmentMap tent_;
};

/// Mean and standard error of a few measurements.
Estimate mean_of(const std::vector<double>& values);

}  // namespace opal
