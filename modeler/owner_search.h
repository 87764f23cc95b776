// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>

#include "formats/opal_asset.h"
#include "modeler/block_tree.h"

namespace opal {

/// Owners are searched in cubes of this size.
inline constexpr std::int32_t cell_size = 4;
inline constexpr std::int32_t cell_voxels = cell_size * cell_size * cell_size;

/// The places that a cell's voxels ask about, where these are not the voxels' centres.
struct CellPoints {
    explicit CellPoints(std::span<const openvdb::Vec3d> points_mm) {
        for (std::size_t n = 0; n < points_mm.size(); ++n)
            for (int axis = 0; axis < 3; ++axis) mm[axis][n] = points_mm[n][axis];
    }
    double mm[3][cell_voxels];
};

/// The nearest site of each voxel of a cell so far. Loops run site by site over fixed arrays, which compilers turn into vector
/// code; the formula is the metric's, operation by operation, and a later site wins only where it is nearer, so ties go to the
/// first.
template <typename Metric>
class OwnerSearch {
  public:
    OwnerSearch() { std::fill(std::begin(smallest_mm_), std::end(smallest_mm_), std::numeric_limits<double>::infinity()); }

    /// At the voxels' centres.
    void offer(const Site& site, std::int32_t number, const VoxelBlock& cell, double voxel_size_mm) {
        double term[3][cell_size];
        for (int axis = 0; axis < 3; ++axis)
            for (std::int32_t i = 0; i < cell_size; ++i)
                term[axis][i] = Metric::axis_term((cell.origin[axis] + i) * voxel_size_mm - site.position_mm[axis]);
        const double weight = static_cast<double>(site.weight_mm);
        for (std::int32_t row = 0; row < cell_size * cell_size; ++row) {
            const double in_plane = term[0][row / cell_size] + term[1][row % cell_size];
            for (std::int32_t k = 0; k < cell_size; ++k)
                keep_nearer(row * cell_size + k, Metric::delta_of_terms_mm(in_plane + term[2][k], weight), number);
        }
    }

    /// At other places.
    void offer(const Site& site, std::int32_t number, const CellPoints& points) {
        const double weight = static_cast<double>(site.weight_mm);
        for (std::int32_t voxel = 0; voxel < cell_voxels; ++voxel)
            keep_nearer(voxel,
                        Metric::delta_mm(points.mm[0][voxel] - site.position_mm[0], points.mm[1][voxel] - site.position_mm[1],
                                         points.mm[2][voxel] - site.position_mm[2], weight),
                        number);
    }

    /// The number under which the voxel's owner was offered.
    std::size_t owner(std::int32_t voxel) const { return static_cast<std::size_t>(owner_[voxel]); }

  private:
    void keep_nearer(std::int32_t voxel, double delta_mm, double number) {
        const bool nearer = delta_mm < smallest_mm_[voxel];
        smallest_mm_[voxel] = nearer ? delta_mm : smallest_mm_[voxel];
        owner_[voxel] = nearer ? number : owner_[voxel];
    }

    double smallest_mm_[cell_voxels];
    double owner_[cell_voxels] = {};  ///< as a double, so that comparison and choice have equal widths
};

}  // namespace opal
