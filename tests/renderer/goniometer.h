// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/cpu/embree_scene.h"
#include "renderer/host/host_scene.h"

namespace opal {

/// A sample between a distant emitter, the scene's environment, and a distant detector, at one wavelength: what a goniometer
/// measures. The detector is a camera without perspective, whose pictures a backend draws (backends.h).
class Goniometer {
  public:
    /// `scene_toml` holds the sample around the origin, within `radius_mm` of it, and the environment.
    Goniometer(const std::string& scene_toml, double radius_mm, std::string backend = "cpu");

    struct Reading {
        double mean = 0.0, standard_error = 0.0;
    };

    /// Radiance over the environment's white that reaches a detector towards which light travels along -`direction`, from a
    /// square spot of half the edge `half_edge_mm` at the origin: paths are followed backwards, from the detector along
    /// `direction`; at least as many as `paths`.
    Reading radiance(Vec3 direction, double half_edge_mm, double wavelength_nm, int paths, std::uint64_t seed) const;

    /// Flux from the emitter through the whole sample into a detector whose sensitivity over the sphere is `detector`'s radiance
    /// (mm^2 sr, for emitters and detectors of 1): the same with emitter and detector exchanged, whatever the sample (Helmholtz).
    /// The detector's directions are drawn, many paths for each.
    Reading exchange(const EnvironmentMap& detector, double wavelength_nm, int paths, std::uint64_t seed) const;

    const HostScene& scene() const { return scene_; }

  private:
    double radius_mm_;
    std::string backend_;
    std::vector<std::string> notices_;
    HostScene scene_;
    EmbreeScene intersector_;
};

/// Writes an environment picture that is 1 within `angle_deg` of a direction and 0 elsewhere (texels of 1 degree).
void write_cap(const std::filesystem::path& path, Vec3 direction, double angle_deg);
EnvironmentMap read_environment(const std::filesystem::path& path);

}  // namespace opal
