// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "formats/recipe.h"
#include "modeler/neighbour_graph.h"

namespace opal {

/// Which sites grew together into one grain.
struct Sintering {
    std::vector<std::int32_t> grain_of_site;  ///< from 1, in the order of the grains' lowest sites; 0 for hidden sites
    std::int32_t num_grains = 0;
    std::size_t num_kept_bonds = 0;
    double probability = 0.0;             ///< of a bond to be kept: asked for, or kept / all where a number of grains was
    double largest_grain_fraction = 0.0;  ///< of the visible sites
    /// Estimated percolation threshold of this graph: where the mean size of the grains other than the largest peaks. None
    /// without bonds.
    std::optional<double> threshold;
};

/// Keeps each bond of the graph with the recipe's probability, or in random order until as many grains are left as the recipe
/// wants (one sweep of M. E. J. Newman & R. M. Ziff, "Fast Monte Carlo algorithm for site or bond percolation", Phys. Rev. E 64,
/// 2001). The random number of a bond is a pure function of (seed, its two sites), so a higher probability only adds bonds.
/// Throws InputError where the number of grains cannot be reached, naming the range.
Sintering sinter(const NeighbourGraph& graph, const std::vector<char>& hidden, const SinteringRecipe& recipe, std::uint64_t seed);

}  // namespace opal
