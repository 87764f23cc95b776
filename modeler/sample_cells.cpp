// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/sample_cells.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace opal {
namespace {

/// More cells than this per point waste memory; cells are then made larger than the reach.
constexpr double max_cells_per_point = 16.0;

}  // namespace

SampleCells::SampleCells(const std::vector<openvdb::Vec3d>& points, double reach)
    : reach_(reach), squared_reach_(reach * reach), index_(points.size()) {
    openvdb::BBoxd box;
    for (const openvdb::Vec3d& point : points) box.expand(point);
    const openvdb::Vec3d extents = points.empty() ? openvdb::Vec3d(0.0) : box.extents();
    origin_ = points.empty() ? openvdb::Vec3d(0.0) : box.min();
    // A little more than the reach, so that rounding leaves no neighbour two cells away.
    cell_size_ = std::max(reach * (1.0 + 1.0e-9), std::numeric_limits<double>::min());
    const double max_cells = 64.0 + max_cells_per_point * static_cast<double>(points.size());
    const auto cells_at = [&](double size) {
        return (extents.x() / size + 1.0) * (extents.y() / size + 1.0) * (extents.z() / size + 1.0);
    };
    while (cells_at(cell_size_) > max_cells) cell_size_ *= 1.25;
    for (int axis = 0; axis < 3; ++axis)
        num_cells_[static_cast<std::size_t>(axis)] = cell_along(axis, origin_[axis] + extents[axis]) + 1;

    const auto cell_of = [&](const openvdb::Vec3d& point) {
        return (cell_along(0, point.x()) * num_cells_[1] + cell_along(1, point.y())) * num_cells_[2] + cell_along(2, point.z());
    };
    cell_begin_.assign(num_cells_[0] * num_cells_[1] * num_cells_[2] + 1, 0);
    for (const openvdb::Vec3d& point : points) ++cell_begin_[cell_of(point) + 1];
    for (std::size_t cell = 0; cell + 1 < cell_begin_.size(); ++cell) cell_begin_[cell + 1] += cell_begin_[cell];
    std::vector<std::uint32_t> next(cell_begin_.begin(), cell_begin_.end() - 1);
    for (auto& coordinates : axis_) coordinates.resize(points.size());
    for (std::size_t n = 0; n < points.size(); ++n) {
        const std::size_t place = next[cell_of(points[n])]++;
        index_[place] = static_cast<std::uint32_t>(n);
        for (int axis = 0; axis < 3; ++axis) axis_[static_cast<std::size_t>(axis)][place] = points[n][axis];
    }
}

double shortest_distance(const std::vector<openvdb::Vec3d>& points, double typical) {
    if (points.size() < 2) return 0.0;
    const double none = std::numeric_limits<double>::infinity();
    for (double reach = typical;; reach *= 2.0) {
        const SampleCells cells(points, reach);
        const double squared = tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, cells.size()), none,
            [&](const tbb::blocked_range<std::size_t>& range, double smallest) {
                for (std::size_t n = range.begin(); n != range.end(); ++n)
                    cells.for_each_neighbour(
                        n, [&](std::size_t, double squared_distance) { smallest = std::min(smallest, squared_distance); });
                return smallest;
            },
            [](double a, double b) { return std::min(a, b); });
        if (squared < none) return std::sqrt(squared);
    }
}

}  // namespace opal
