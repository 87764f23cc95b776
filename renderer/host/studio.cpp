// SPDX-License-Identifier: Apache-2.0
#include <iterator>
#include <vector>

#include "formats/units.h"
#include "renderer/host/environment_map.h"

namespace opal {
namespace {

/// A rectangular soft box at infinity, seen under an angle, with a soft edge.
struct SoftBox {
    double azimuth_deg;    ///< of its centre, counter-clockwise from +X
    double elevation_deg;  ///< above the horizon
    double half_width_deg, half_height_deg;
    double edge;  ///< fraction of the half size over which it fades
    Rgb radiance;
};

constexpr SoftBox soft_boxes[] = {
    {150.0, 46.0, 9.5, 8.0, 0.12, {30.0f, 29.3f, 28.0f}},
    {-14.0, 28.0, 3.5, 16.0, 0.15, {14.0f, 14.3f, 15.0f}},
    {-80.0, 68.0, 7.0, 5.0, 0.2, {12.0f, 12.0f, 12.0f}},
    {70.0, 30.0, 16.0, 3.0, 0.2, {9.0f, 9.0f, 9.2f}},
};

float fade(double offset, double half_size, double edge) {
    const double t = (half_size - std::abs(offset)) / (edge * half_size);
    const double clamped = t < 0.0 ? 0.0 : (t > 1.0 ? 1.0 : t);
    return float(clamped * clamped * (3.0 - 2.0 * clamped));
}

/// A soft box's axes, and its half sizes at unit distance.
struct SoftBoxFrame {
    explicit SoftBoxFrame(const SoftBox& box) {
        const double azimuth = units::rad_from_deg(box.azimuth_deg), elevation = units::rad_from_deg(box.elevation_deg);
        centre = {float(std::cos(elevation) * std::cos(azimuth)), float(std::cos(elevation) * std::sin(azimuth)),
                  float(std::sin(elevation))};
        right = normalize(cross({0.0f, 0.0f, 1.0f}, centre));
        up = cross(centre, right);
        half_width = std::tan(units::rad_from_deg(box.half_width_deg));
        half_height = std::tan(units::rad_from_deg(box.half_height_deg));
    }
    Vec3 centre, right, up;
    double half_width, half_height;
};

float coverage(const SoftBox& box, const SoftBoxFrame& frame, Vec3 direction) {
    const double depth = double(dot(direction, frame.centre));
    if (depth <= 0.0) return 0.0f;
    const double x = double(dot(direction, frame.right)) / depth, y = double(dot(direction, frame.up)) / depth;
    return fade(x, frame.half_width, box.edge) * fade(y, frame.half_height, box.edge);
}

}  // namespace

Rgb studio_radiance(Vec3 direction) {
    // A dim room, a little brighter towards the ceiling.
    const float surround = 0.025f + 0.03f * max_of(0.0f, direction.z);
    Rgb sum{surround, surround, surround * 1.04f};
    static const std::vector<SoftBoxFrame> frames(std::begin(soft_boxes), std::end(soft_boxes));
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const SoftBox& box = soft_boxes[i];
        const float covered = coverage(box, frames[i], direction);
        sum.r += covered * box.radiance.r;
        sum.g += covered * box.radiance.g;
        sum.b += covered * box.radiance.b;
    }
    return sum;
}

}  // namespace opal
