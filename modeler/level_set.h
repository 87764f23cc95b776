// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

namespace opal {

class Shape;

/// Voxels to each side of the surface whose distance a level set stores.
inline constexpr double level_set_half_width = 3.0;

/// A level set of the shape's exact distance, voxel centres at integer multiples of `voxel_size_mm`. Blocks that the distance at
/// their centre shows to be out of the band are never looked into, so the work grows with the surface. Inside tiles are negative.
/// Throws Interrupted on Ctrl-C.
openvdb::FloatGrid::Ptr level_set_from_distance(const Shape& shape, double voxel_size_mm);

/// Names and marks a level set as the asset's schema wants it.
void label_as_shape(openvdb::FloatGrid& level_set, double voxel_size_mm);

/// Where a block of voxels lies.
enum class BlockSide { outside, inside, crossing };

/// Sides of blocks of 8 to 128 voxels (aligned to their size) and of single voxels, read from a level set's tree without visiting
/// voxels. Larger blocks count as crossing.
BlockSide block_side(const openvdb::FloatTree& level_set, const openvdb::Coord& origin, std::int32_t size);

}  // namespace opal
