// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/recipe.h"
#include "formats/scene.h"

namespace opal {

/// What one picture can show of an opal, and so how finely it is worth modelling.
struct SceneNeeds {
    double pixel_footprint_mm = 0.0;  ///< of one pixel at the gem's point nearest to the camera, in the gem's own millimetres
    double voxel_size_mm = 0.0;       ///< chosen
    double recipe_voxel_size_mm = 0.0;
    bool exact_grains = false;           ///< taken from the sites: voxels are those of the surface alone
    double boundary_error_mm = 0.0;      ///< largest distance of a voxel's corner from its centre: sqrt(3) / 2 voxels
    double boundary_error_pixels = 0.0;  ///< that, at the nearest point
    double lens_magnification = 1.0;     ///< at most, of what lies behind a curved front: n / (2 - n), a ball's far side
    std::vector<std::string> dropped;    ///< what was left out, and why it cannot be seen
};

/// Fits `recipe` to a scene: a voxel size at which no grain boundary is off by more than `accepted_error_pixels` at the gem's
/// nearest point, whatever the recipe said (but four voxels along the longest side), no labels where the renderer finds the
/// grains from the sites, and no field or display grid that the picture cannot show. A field is dropped where its variation along
/// the longest straight path changes transmission by less than half an 8-bit step. `bounds_mm` is the shape's box, `output` the
/// file that the scene's [[object]] of kind opal names (its only opal otherwise). A perspective camera in the gem's box has no
/// nearest point: the recipe's resolution is kept and said to be. Throws InputError where no opal of the scene can be meant.
SceneNeeds fit_to_scene(Recipe& recipe, const SceneDescription& scene, const std::filesystem::path& output,
                        const openvdb::BBoxd& bounds_mm, double accepted_error_pixels);

nlohmann::json scene_needs_to_json(const SceneNeeds& needs);

/// A few lines for a person.
std::string scene_needs_summary(const SceneNeeds& needs);

}  // namespace opal
