// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/recipe.h"
#include "formats/scene.h"
#include "modeler/shape.h"

namespace opal {

/// What one picture can show of an opal, and so how finely it is worth modelling.
struct SceneNeeds {
    double pixel_footprint_mm = 0.0;  ///< of one pixel at the gem's point nearest to the camera, in the gem's own millimetres
    double voxel_size_mm = 0.0;       ///< chosen
    double recipe_voxel_size_mm = 0.0;
    bool exact_grains = false;  ///< taken from the sites: voxels are those of the surface alone
    /// Of grains from voxels: sqrt(3) / 2 voxels, from centre to corner. Of a surface: what was found, up to that.
    double boundary_error_mm = 0.0;
    std::size_t surface_places = 0;      ///< at which the surface was looked at; 0: it was not, for grains from voxels
    bool finest_surface = false;         ///< its edges or thin parts take the finest voxels of use
    double boundary_error_pixels = 0.0;  ///< that, at the nearest point; of a surface: where it shows most
    double lens_magnification = 1.0;     ///< at most, of what lies behind a curved front: n / (2 - n), a ball's far side
    std::vector<std::string> dropped;    ///< what was left out, and why it cannot be seen
};

/// Fits `recipe` to a scene. Voxels, whatever the recipe said: as small as it takes for no grain boundary to be off by more than
/// `accepted_error_pixels` at the gem's nearest point in any frame; at least 32 along the longest side and 4 along the shortest,
/// at most 2000. Where the renderer finds the grains from the sites and nothing else varies, only the surface takes voxels, and
/// no smaller ones than its curvature in the picture asks for (coarsest_surface_voxels); at least 96 along the longest side and
/// 16 along the shortest. No labels then, and no field or display grid that the picture cannot show. A field is dropped where its
/// variation along the longest straight path changes transmission by less than half an 8-bit step. `output`: the file that the
/// scene's [[object]]s of kind opal name (its only one otherwise). Where the gem's box reaches behind a perspective camera there
/// is no nearest point: the recipe's resolution is kept and said to be. Throws InputError where no opal of the scene can be
/// meant.
SceneNeeds fit_to_scene(Recipe& recipe, const SceneDescription& scene, const std::filesystem::path& output, const Shape& shape,
                        double accepted_error_pixels);

nlohmann::json scene_needs_to_json(const SceneNeeds& needs);

/// A few lines for a person.
std::string scene_needs_summary(const SceneNeeds& needs);

}  // namespace opal
