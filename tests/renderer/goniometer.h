// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "renderer/cpu/embree_scene.h"
#include "renderer/host/bvh.h"
#include "renderer/host/host_scene.h"
#include "renderer/host/scene_copy.h"

namespace opal {

/// A sample between a distant emitter, the scene's environment, and a distant detector, at one wavelength: what a goniometer
/// measures.
class Goniometer {
  public:
    /// `scene_toml` holds the sample around the origin, within `radius_mm` of it, and the environment. `as_devices_do`: over a
    /// copy of the scene, with the hierarchy of bounds that devices walk.
    Goniometer(const std::string& scene_toml, double radius_mm, bool as_devices_do = false);

    struct Reading {
        double mean = 0.0, standard_error = 0.0;
    };

    /// Radiance over the environment's white that reaches a detector towards which light travels along -`direction`, from a spot
    /// of `spot_radius_mm` at the origin: paths are followed backwards, from the detector along `direction`.
    Reading radiance(Vec3 direction, double spot_radius_mm, double wavelength_nm, int paths, std::uint64_t seed) const;

    /// Flux from the emitter through the whole sample into a detector whose sensitivity over the sphere is `detector`'s radiance
    /// (mm^2 sr, for emitters and detectors of 1): the same with emitter and detector exchanged, whatever the sample (Helmholtz).
    Reading exchange(const EnvironmentMap& detector, double wavelength_nm, int paths, std::uint64_t seed) const;

    const HostScene& scene() const { return scene_; }

  private:
    double trace(const Ray& ray, double wavelength_nm, std::uint32_t path, std::uint64_t seed) const;

    double radius_mm_;
    std::vector<std::string> notices_;
    HostScene scene_;
    EmbreeScene intersector_;
    HostArrayCopier arrays_;
    std::optional<Bvh> bvh_;  ///< where rays are traced as devices do
    SceneView view_;
};

/// Writes an environment picture that is 1 within `angle_deg` of a direction and 0 elsewhere (texels of 1 degree).
void write_cap(const std::filesystem::path& path, Vec3 direction, double angle_deg);
EnvironmentMap read_environment(const std::filesystem::path& path);

}  // namespace opal
