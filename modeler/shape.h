// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <memory>
#include <vector>

#include "formats/bezier_patch.h"
#include "formats/recipe.h"

namespace opal {

/// The solid that becomes opal. Lengths are millimetres, Z is up. Primitives and Bezier shapes are centred on the z axis and rest
/// on the ground: their lowest point has z = 0. A mesh stays where its file puts it.
class Shape {
  public:
    virtual ~Shape() = default;

    /// Exact Euclidean distance to the surface, negative inside. Safe to call from several threads.
    virtual double signed_distance_mm(const openvdb::Vec3d& point_mm) const = 0;
    /// Whether the point lies inside; the same answer as `signed_distance_mm() < 0`, where possible at less cost.
    virtual bool contains(const openvdb::Vec3d& point_mm) const { return signed_distance_mm(point_mm) < 0.0; }
    /// The smallest axis-aligned box around the solid.
    virtual openvdb::BBoxd bounds_mm() const = 0;
    /// The surface as a level set named `shape`: distances in mm in a band of `level_set_half_width` voxels to both sides.
    virtual openvdb::FloatGrid::Ptr level_set(double voxel_size_mm) const;
    /// The surface as Bezier patches, for shapes that are made of them; else empty.
    virtual std::vector<BezierPatch> bezier_patches() const { return {}; }
};

/// The shape that a recipe describes. Throws InputError for sizes that leave nothing of it and for meshes that bound no solid.
std::unique_ptr<Shape> make_shape(const ShapeRecipe& recipe);

}  // namespace opal
