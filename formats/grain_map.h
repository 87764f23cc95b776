// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>
#include <openvdb/tree/LeafManager.h>

#include <memory>

namespace opal {

/// A fog grid with the transform, leaves and tiles of `grain_id` whose active values are `value_of(grain)`; 0 outside.
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

}  // namespace opal
