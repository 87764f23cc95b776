// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstdint>

namespace opal {

/// Edge of OpenVDB's leaf and of the node above it, in voxels: the sizes that constant tiles can have.
inline constexpr std::int32_t leaf_size = 8;
inline constexpr std::int32_t node_size = 128;
/// Children of blocks larger than this are worked on in parallel.
inline constexpr std::int32_t serial_block_size = 32;

/// A cube of voxels, `size` along each edge, `origin` its lowest corner.
struct VoxelBlock {
    openvdb::Coord origin;
    std::int32_t size;

    VoxelBlock child(int octant) const {
        const std::int32_t half = size / 2;
        return {origin.offsetBy((octant & 4) ? half : 0, (octant & 2) ? half : 0, (octant & 1) ? half : 0), half};
    }
    openvdb::CoordBBox box() const { return openvdb::CoordBBox::createCube(origin, size); }
    /// Middle of the voxel centres.
    openvdb::Vec3d centre_mm(double voxel_size_mm) const {
        return (origin.asVec3d() + openvdb::Vec3d(0.5 * (size - 1))) * voxel_size_mm;
    }
    /// Distance from there to the outermost voxel centres.
    double half_diagonal_mm(double voxel_size_mm) const { return 0.5 * std::sqrt(3.0) * (size - 1) * voxel_size_mm; }
};

/// The block of 128 * 2^n voxels, aligned to OpenVDB's nodes, that covers a box of voxels.
inline VoxelBlock covering_block(const openvdb::CoordBBox& box) {
    const openvdb::Coord origin = box.min() & ~(node_size - 1);
    const openvdb::Coord extents = openvdb::CoordBBox(origin, box.max()).extents();
    std::int32_t size = node_size;
    while (size < extents[extents.maxIndex()]) size *= 2;
    return {origin, size};
}

/// Calls `visit` for each of the 8 children: in parallel for large blocks, in order for small ones.
template <typename Visitor>
void for_each_child(const VoxelBlock& block, const Visitor& visit) {
    if (block.size > serial_block_size)
        tbb::parallel_for(0, 8, [&](int octant) { visit(block.child(octant)); });
    else
        for (int octant = 0; octant < 8; ++octant) visit(block.child(octant));
}

}  // namespace opal
