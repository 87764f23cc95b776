// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/shape.h"

#include "modeler/bezier_shape.h"
#include "modeler/box_shape.h"
#include "modeler/cabochon_shape.h"
#include "modeler/ellipsoid_shape.h"
#include "modeler/level_set.h"
#include "modeler/mesh_shape.h"

namespace opal {

openvdb::FloatGrid::Ptr Shape::level_set(double voxel_size_mm) const {
    return level_set_from_distance(*this, voxel_size_mm);
}

std::unique_ptr<Shape> make_shape(const ShapeRecipe& recipe) {
    const openvdb::Vec3d size_mm(recipe.size_mm.data());
    switch (recipe.kind) {
        case ShapeKind::ellipsoid:
        case ShapeKind::sphere:
            return std::make_unique<EllipsoidShape>(size_mm);
        case ShapeKind::box:
            return std::make_unique<BoxShape>(size_mm);
        case ShapeKind::cabochon:
            return std::make_unique<CabochonShape>(size_mm, recipe.girdle_mm);
        case ShapeKind::mesh:
            return make_mesh_shape(recipe.mesh_file, recipe.mesh_scale);
        case ShapeKind::bezier:
            return make_bezier_shape(recipe);
    }
    throw std::logic_error("a shape kind without a shape");
}

}  // namespace opal
