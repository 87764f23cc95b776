// SPDX-License-Identifier: Apache-2.0
#include "formats/display_twins.h"

#include <openvdb/tree/LeafManager.h>

#include "formats/opal_asset.h"

namespace opal {
namespace {

/// A grid of the same transform, leaves and tiles whose active values are `value_of` the grain; 0 outside.
template <typename Grid, typename ValueOf>
typename Grid::Ptr map_grains(const openvdb::Int32Grid& grain_id, const char* name, const ValueOf& value_of) {
    using Tree = typename Grid::TreeType;
    const openvdb::Int32Tree& ids = grain_id.tree();
    const auto tree = std::make_shared<Tree>(ids, openvdb::zeroVal<typename Grid::ValueType>(), openvdb::TopologyCopy());
    openvdb::tree::LeafManager<Tree> leaves(*tree);
    leaves.foreach ([&](typename Tree::LeafNodeType& leaf, std::size_t) {
        const openvdb::Int32Tree::LeafNodeType* const source = ids.probeConstLeaf(leaf.origin());
        for (auto value = leaf.beginValueOn(); value; ++value) value.setValue(value_of(source->getValue(value.pos())));
    });
    auto tile = tree->beginValueOn();
    tile.setMaxDepth(Tree::ValueOnIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) tile.setValue(value_of(ids.getValue(tile.getCoord())));

    const typename Grid::Ptr grid = Grid::create(tree);
    grid->setTransform(grain_id.transform().copy());
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setName(name);
    return grid;
}

}  // namespace

openvdb::FloatGrid::Ptr make_grain_id_float(const openvdb::Int32Grid& grain_id) {
    return map_grains<openvdb::FloatGrid>(grain_id, grid_names::grain_id_float,
                                          [](std::int32_t grain) { return static_cast<float>(grain); });
}

openvdb::Vec3SGrid::Ptr make_orientation_rgb(const openvdb::Int32Grid& grain_id) {
    return map_grains<openvdb::Vec3SGrid>(grain_id, grid_names::orientation_rgb, grain_display_color);
}

}  // namespace opal
