// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "formats/command.h"
#include "formats/scene.h"
#include "picture_error.h"
#include "renderer/cpu/light_guides.h"
#include "renderer/host/environment_map.h"
#include "renderer/host/host_scene.h"
#include "spectral_lines.h"

namespace opal {

/// What lights a scene's gem: its own environment, or the built-in light tent, whose broad light leaves far less noise.
enum class Lighting { of_the_scene, tent };

/// One scene with some settings in memory, and what has been drawn of it, seed by seed.
class Subject {
  public:
    /// `settings`: overrides of the scene.
    Subject(const std::filesystem::path& scene, const std::vector<std::string>& settings, SpectralChoice spectral);

    /// The pixels whose centre shows a transparent body.
    std::vector<std::uint32_t> pixels() const { return gem_pixels(host_.view(), intersector_); }
    std::size_t memory_bytes() const;
    double load_s() const { return load_s_; }
    int width() const { return host_.view().width; }
    /// Means of the pixels drawn, for every seed.
    const SeedPictures& pictures(Lighting lighting = Lighting::of_the_scene) const {
        return lighting == Lighting::tent ? tent_pictures_ : pictures_;
    }
    /// Processor time per sample in the scene's own light, for every seed.
    const std::vector<double>& sample_s() const { return sample_s_; }

    /// Draws the pixels once more, with another seed.
    void draw(const std::vector<std::uint32_t>& pixels, int samples, std::uint64_t seed,
              Lighting lighting = Lighting::of_the_scene);

  private:
    template <int N>
    void draw_lanes(const std::vector<std::uint32_t>& pixels, int samples, std::uint64_t seed, Lighting lighting);
    template <int N>
    Opponent mean_of_pixel(const SceneView& view, std::uint32_t pixel, int samples) const;

    const Stopwatch watch_;
    std::vector<std::string> notices_;
    const SceneDescription description_;
    const HostScene host_;
    const EmbreeScene intersector_;
    const LightGuides guides_;
    const SpectralLines lines_;
    const double load_s_;
    const EnvironmentMap tent_;
    SeedPictures pictures_, tent_pictures_;
    std::vector<double> sample_s_;
};

/// Mean and standard error of a few measurements.
Estimate mean_of(const std::vector<double>& values);

}  // namespace opal
