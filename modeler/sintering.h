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
    double probability = 0.0;             ///< asked for, or at which the bonds are kept that leave the wanted number of grains
    double largest_grain_fraction = 0.0;  ///< of the visible sites
    /// Estimated percolation threshold of this graph: where the mean size of the grains other than the largest peaks. None
    /// without bonds.
    std::optional<double> threshold;
};

/// Keeps each bond of the graph with the recipe's probability; or bonds in the order of their random numbers until as many
/// grains are left as the recipe wants, or as balls of its mean diameter d fill the sites' volume: V / (pi d^3 / 6), rounded.
/// One Newman-Ziff sweep finds all of that. `bond_weights`, one per pair of the graph or none, prefer some bonds to others: see
/// BondOrder. A higher probability only adds bonds. Throws InputError where the number of grains cannot be reached, naming the
/// range.
Sintering sinter(const NeighbourGraph& graph, const std::vector<char>& hidden, const SinteringRecipe& recipe, std::uint64_t seed,
                 const std::vector<double>& bond_weights = {}, double sites_volume_mm3 = 0.0);

}  // namespace opal
