// SPDX-License-Identifier: Apache-2.0
#include "formats/units.h"
#include "renderer/host/environment_map.h"

namespace opal {
namespace {

constexpr double lamp_azimuth_deg = 150.0, lamp_elevation_deg = 50.0;
/// Of the cloth below, of the step from there to above, and where the lamp is nearest.
constexpr float below = 0.08f, above = 0.3f, lit = 2.4f;

Vec3 towards_lamp() {
    const double azimuth = units::rad_from_deg(lamp_azimuth_deg), elevation = units::rad_from_deg(lamp_elevation_deg);
    return {float(std::cos(elevation) * std::cos(azimuth)), float(std::cos(elevation) * std::sin(azimuth)),
            float(std::sin(elevation))};
}

}  // namespace

Rgb tent_radiance(Vec3 direction) {
    const float cosine = max_of(0.0f, dot(direction, towards_lamp()));
    const float radiance = below + 0.5f * above * (1.0f + direction.z) + lit * cosine * cosine * cosine * cosine;
    return {radiance, radiance, radiance};
}

}  // namespace opal
