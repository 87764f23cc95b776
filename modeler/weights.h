// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "formats/opal_asset.h"
#include "formats/recipe.h"
#include "modeler/sites.h"

namespace opal {

/// Sites with their additive weights, in mm: amplitude * (shortest distance between sites) * fractal noise of the position over
/// scale_mm. With an amplitude up to 0.5 no two weights differ by more than the shortest distance, so every site owns something.
/// The voronoi tessellation, weight "none" and a single site give weights 0. Weights are rounded to the float that the file holds
/// before anything is computed from them.
std::vector<Site> weigh_sites(const SiteSet& sites, const GrainsRecipe& recipe);

/// Marks (1) the sites that own nothing: i is hidden by j where w_j - w_i >= |p_i - p_j|; of equal sites in one place the first
/// owns.
std::vector<char> find_hidden_sites(const std::vector<Site>& sites, double spacing_mm);

}  // namespace opal
