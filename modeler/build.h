// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "formats/opal_asset.h"
#include "formats/recipe.h"
#include "modeler/build_report.h"

namespace opal {

struct BuiltOpal {
    OpalAsset asset;
    BuildReport report;
};

/// The whole modeler, from recipe to asset: shape -> sites -> weights -> neighbour graph -> sintering -> level set -> labelling
/// -> orientations -> constants. The same recipe gives the same asset, bit for bit, on any number of threads. Throws InputError
/// for recipes that cannot be built, Interrupted on Ctrl-C.
BuiltOpal build_opal(const Recipe& recipe, const BuildListener& listener);

}  // namespace opal
