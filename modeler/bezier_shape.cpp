// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/bezier_shape.h"

#include <algorithm>

#include "formats/recipe_names.h"
#include "modeler/bezier_cabochon.h"
#include "modeler/bezier_teapot.h"
#include "modeler/bezier_tessellation.h"
#include "modeler/mesh_shape.h"
#include "modeler/mesh_solid.h"

namespace opal {
namespace {

constexpr double default_chord_error = 1.0e-3;  ///< of the longest side

}  // namespace

std::unique_ptr<Shape> make_bezier_shape(const ShapeRecipe& recipe) {
    const bool teapot = recipe.patches == BezierPatches::teapot;
    const auto& size_mm = recipe.size_mm;
    const double longest_mm = teapot ? recipe.longest_mm : std::max({size_mm[0], size_mm[1], size_mm[2]});
    const double chord_error_mm = recipe.chord_error_mm > 0.0 ? recipe.chord_error_mm : default_chord_error * longest_mm;
    std::vector<BezierPatch> patches =
        teapot ? bezier_teapot(longest_mm) : bezier_cabochon(openvdb::Vec3d(size_mm.data()), recipe.girdle_mm);
    const std::string name = "of shape.patches \"" + recipe_names::name(recipe_names::patches, recipe.patches) + '"';
    TriangleMesh solid = solid_from_triangles(tessellate(patches, chord_error_mm), name);
    return make_solid_shape(std::move(solid), std::move(patches));
}

}  // namespace opal
