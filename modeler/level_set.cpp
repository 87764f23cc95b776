// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/level_set.h"

#include <openvdb/tools/SignedFloodFill.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "formats/command.h"
#include "formats/opal_asset.h"
#include "modeler/block_tree.h"
#include "modeler/shape.h"

namespace opal {
namespace {

using FloatLeaf = openvdb::FloatTree::LeafNodeType;
using LeafList = std::vector<std::unique_ptr<FloatLeaf>>;

/// Leaves are filled in cubes of this size, for which one distance at the middle may decide.
constexpr std::int32_t sub_block_size = 4;

class BandBuilder {
  public:
    BandBuilder(const Shape& shape, double voxel_size_mm)
        : shape_(shape), voxel_size_mm_(voxel_size_mm), band_mm_(level_set_half_width * voxel_size_mm) {}

    void visit(const VoxelBlock& block) {
        if (interrupt_requested()) return;
        const double distance_mm = shape_.signed_distance_mm(block.centre_mm(voxel_size_mm_));
        if (std::abs(distance_mm) > block.half_diagonal_mm(voxel_size_mm_) + band_mm_) return;
        if (block.size == leaf_size)
            add_leaf(block);
        else
            for_each_child(block, [this](const VoxelBlock& child) { visit(child); });
    }

    openvdb::FloatGrid::Ptr finish() {
        const auto grid = openvdb::FloatGrid::create(static_cast<float>(band_mm_));
        for (LeafList& list : leaves_)
            for (auto& leaf : list) grid->tree().addLeaf(leaf.release());
        openvdb::tools::signedFloodFill(grid->tree());
        return grid;
    }

  private:
    void add_leaf(const VoxelBlock& block) {
        auto leaf = std::make_unique<FloatLeaf>(block.origin, static_cast<float>(band_mm_), false);
        for (int octant = 0; octant < 8; ++octant) fill(*leaf, block.child(octant));
        if (!leaf->isEmpty()) leaves_.local().push_back(std::move(leaf));
    }

    void fill(FloatLeaf& leaf, const VoxelBlock& block) const {
        static_assert(sub_block_size == leaf_size / 2);
        const double middle_mm = shape_.signed_distance_mm(block.centre_mm(voxel_size_mm_));
        const bool beyond_band = std::abs(middle_mm) > block.half_diagonal_mm(voxel_size_mm_) + band_mm_;
        for (const openvdb::Coord& voxel : block.box()) {
            const double distance_mm = beyond_band ? middle_mm : shape_.signed_distance_mm(voxel.asVec3d() * voxel_size_mm_);
            if (std::abs(distance_mm) < band_mm_)
                leaf.setValueOn(voxel, static_cast<float>(distance_mm));
            else
                leaf.setValueOff(voxel, static_cast<float>(std::copysign(band_mm_, distance_mm)));
        }
    }

    const Shape& shape_;
    double voxel_size_mm_;
    double band_mm_;
    tbb::enumerable_thread_specific<LeafList> leaves_;
};

}  // namespace

openvdb::FloatGrid::Ptr level_set_from_distance(const Shape& shape, double voxel_size_mm) {
    const openvdb::BBoxd bounds_mm = shape.bounds_mm();
    openvdb::CoordBBox voxels(openvdb::Coord::floor(bounds_mm.min() / voxel_size_mm),
                              openvdb::Coord::ceil(bounds_mm.max() / voxel_size_mm));
    voxels.expand(static_cast<std::int32_t>(std::ceil(level_set_half_width)));

    BandBuilder builder(shape, voxel_size_mm);
    builder.visit(covering_block(voxels));
    throw_if_interrupted();
    const openvdb::FloatGrid::Ptr grid = builder.finish();
    label_as_shape(*grid, voxel_size_mm);
    return grid;
}

void label_as_shape(openvdb::FloatGrid& level_set, double voxel_size_mm) {
    level_set.setTransform(openvdb::math::Transform::createLinearTransform(voxel_size_mm));
    level_set.setGridClass(openvdb::GRID_LEVEL_SET);
    level_set.setName(grid_names::shape);
}

BlockSide block_side(const openvdb::FloatTree& level_set, const openvdb::Coord& origin, std::int32_t size) {
    using LeafParent = openvdb::FloatTree::RootNodeType::ChildNodeType::ChildNodeType;
    const auto side_of = [](float value_mm) { return value_mm < 0.0f ? BlockSide::inside : BlockSide::outside; };
    if (size > node_size) return BlockSide::crossing;

    const auto* node = level_set.probeConstNode<LeafParent>(origin);
    if (node == nullptr) return side_of(level_set.getValue(origin));
    for (std::int32_t i = 0; i < size; i += leaf_size)
        for (std::int32_t j = 0; j < size; j += leaf_size)
            for (std::int32_t k = 0; k < size; k += leaf_size)
                if (node->isChildMaskOn(LeafParent::coordToOffset(origin.offsetBy(i, j, k)))) return BlockSide::crossing;
    return side_of(node->getValue(origin));
}

}  // namespace opal
