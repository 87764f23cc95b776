// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "formats/opal_asset.h"
#include "formats/recipe.h"
#include "formats/scene.h"
#include "modeler/build_report.h"

namespace opal {

struct BuiltOpal {
    OpalAsset asset;
    BuildReport report;
    OutputRecipe output;  ///< what of it to write: the recipe's, or what is left of that for a scene
};

/// For which picture an opal is modelled, where it is modelled for one.
struct SceneFit {
    SceneDescription scene;
    std::filesystem::path output;  ///< the file being built: which of the scene's opals is meant
    double accepted_error_pixels = 1.0;
};

/// The whole modeler, from recipe to asset: shape -> sites -> weights -> neighbour graph -> sintering -> level set -> labelling
/// -> orientations -> constants. The same recipe gives the same asset, bit for bit, on any number of threads. With a
/// scene, the recipe is first fitted to what its picture can show (scene_needs.h). Throws InputError for recipes that cannot be
/// built, Interrupted on Ctrl-C.
BuiltOpal build_opal(const Recipe& recipe, const BuildListener& listener,
                     const std::optional<SceneFit>& scene_fit = std::nullopt);

}  // namespace opal
