// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/point_grid.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace opal {
namespace {

/// Cell numbers along an axis fit this many bits of a key.
constexpr int key_bits = 21;
constexpr double max_cells_per_axis = 1 << 20;

}  // namespace

PointGrid::PointGrid(const std::vector<openvdb::Vec3d>& points, double cell_size) {
    openvdb::BBoxd box;
    for (const openvdb::Vec3d& point : points) box.expand(point);
    const openvdb::Vec3d extents = points.empty() ? openvdb::Vec3d(0.0) : box.extents();
    const double longest = std::max({extents.x(), extents.y(), extents.z()});
    origin_ = points.empty() ? openvdb::Vec3d(0.0) : box.min();
    cell_size_ = std::max({cell_size, longest / max_cells_per_axis, std::numeric_limits<double>::min()});

    const std::size_t num_buckets = std::bit_ceil(std::max<std::size_t>(2, points.size()));
    bucket_shift_ = 64 - std::countr_zero(num_buckets);
    bucket_begin_.assign(num_buckets + 1, 0);
    std::vector<std::uint64_t> keys(points.size());
    for (std::size_t n = 0; n < points.size(); ++n) {
        keys[n] = key_of(cell_of(points[n]));
        ++bucket_begin_[bucket_of(keys[n]) + 1];
    }
    for (std::size_t b = 0; b < num_buckets; ++b) bucket_begin_[b + 1] += bucket_begin_[b];
    std::vector<std::size_t> next(bucket_begin_.begin(), bucket_begin_.end() - 1);
    entries_.resize(points.size());
    for (std::size_t n = 0; n < points.size(); ++n) entries_[next[bucket_of(keys[n])]++] = {points[n], keys[n], n};
}

PointGrid::Cell PointGrid::cell_of(const openvdb::Vec3d& point) const {
    // Places outside the points' box share the cells just beyond its faces.
    Cell cell;
    for (int axis = 0; axis < 3; ++axis)
        cell.index[axis] = static_cast<std::int64_t>(
            std::clamp(std::floor((point[axis] - origin_[axis]) / cell_size_), -1.0, max_cells_per_axis + 1.0));
    return cell;
}

std::uint64_t PointGrid::key_of(const Cell& cell) {
    std::uint64_t key = 0;
    for (const std::int64_t index : cell.index) key = (key << key_bits) | static_cast<std::uint64_t>(index + 1);
    return key;
}

}  // namespace opal
