// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <vector>

#include "modeler/shape.h"

namespace opal {

struct ShapeSamples {
    std::vector<openvdb::Vec3d> positions_mm;
    double shape_volume_mm3 = 0.0;  ///< from the part of the tries that hit: standard error at most 1 %
};

/// `count` points, independent and uniform inside the shape, by rejection: try k is a pure function of (seed, k) and of the boxes
/// that it is drawn from. There is one box, the shape's bounds, unless fewer than one try in 16 would hit; then boxes around the
/// shape are halved, and those that its distance shows to be outside dropped, until they fit it better, so that needles and
/// plates that lie askew in their bounds cost little. Throws InputError where the shape holds no place at all, or fills less than
/// 1e-4 of a million boxes.
ShapeSamples sample_uniformly(const Shape& shape, std::size_t count, std::uint64_t seed);

/// `count` points uniform in a box, point k a pure function of (seed, k).
std::vector<openvdb::Vec3d> sample_box(const openvdb::BBoxd& box_mm, std::size_t count, std::uint64_t seed);

}  // namespace opal
