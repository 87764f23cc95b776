// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanovdb/NanoVDB.h>

#include "renderer/core/vec.h"

namespace opal {

using FieldGrid = nanovdb::NanoGrid<float>;

/// One coefficient of the body that varies from place to place.
struct FieldView {
    const FieldGrid* grid = nullptr;  ///< null: 1 everywhere
    real voxels_per_mm = 1.0f;        ///< object space
    Vec3 index_of_origin;             ///< index coordinates of the object's origin; voxel centres are at integers
};

/// A field at a place (object space, mm), linear between the centres of voxels.
OPAL_HD inline real field_value(const FieldView& field, Vec3 position_mm) {
    using Leaf = FieldGrid::TreeType::LeafNodeType;
    const Vec3 index = field.voxels_per_mm * position_mm + field.index_of_origin;
    const Vec3 floor_index{floor(index.x), floor(index.y), floor(index.z)};
    const Vec3 t = index - floor_index;
    const nanovdb::Coord low(int(floor_index.x), int(floor_index.y), int(floor_index.z));
    real corner[8];  // z fastest, as in a leaf
    nanovdb::DefaultReadAccessor<float> accessor(field.grid->tree().root());
    constexpr int last = Leaf::DIM - 1;
    const bool one_leaf = (low[0] & last) != last && (low[1] & last) != last && (low[2] & last) != last;
    const Leaf* leaf = one_leaf ? accessor.probeLeaf(low) : nullptr;
    if (leaf) {
        const uint32_t first = Leaf::CoordToOffset(low);
        for (uint32_t k = 0; k < 8; ++k)
            corner[k] = leaf->getValue(first + (k & 1u) + ((k >> 1) & 1u) * Leaf::DIM + (k >> 2) * Leaf::DIM * Leaf::DIM);
    } else {
        for (int k = 0; k < 8; ++k) corner[k] = accessor.getValue(low + nanovdb::Coord(k >> 2, (k >> 1) & 1, k & 1));
    }
    for (int k = 0; k < 4; ++k) corner[k] = (1.0f - t.x) * corner[k] + t.x * corner[k + 4];
    for (int k = 0; k < 2; ++k) corner[k] = (1.0f - t.y) * corner[k] + t.y * corner[k + 2];
    return (1.0f - t.z) * corner[0] + t.z * corner[1];
}

}  // namespace opal
