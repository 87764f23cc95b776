// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "formats/recipe.h"
#include "modeler/orientations.h"
#include "modeler/sintering.h"
#include "modeler/site_network.h"

namespace opal {

/// Which sites form which grain, and how each grain's lattice lies.
struct GrainGrowth {
    Sintering sintering;
    std::vector<Orientation> grain_orientations;
};

/// What the recipe's `preference` makes of the network's bonds: one weight per pair, or none without a preference. `of_sites`
/// are the sites' orientations, needed for preference misorientation alone.
std::vector<double> bond_weights(const Recipe& recipe, const SiteNetwork& network, const std::vector<Orientation>& of_sites);

/// The sites' own orientations where grains form by them (preference misorientation); else none.
std::vector<Orientation> orientations_to_sinter_by(const Recipe& recipe, const SiteNetwork& network);

/// `sinter` with what the network knows.
Sintering sinter_network(const Recipe& recipe, const SiteNetwork& network, const std::vector<double>& weights);

/// The stages sintering and orientations. With preference misorientation every site draws its orientation first, and a grain has
/// its lowest site's; else every grain draws one. Throws InputError where the recipe's number of grains cannot be reached, or its
/// table of orientations does not fit the grains.
GrainGrowth grow_grains(const Recipe& recipe, const SiteNetwork& network, StageRunner& stages);

}  // namespace opal
