// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/sintering.h"

#include <fmt/format.h>

#include <algorithm>

#include "formats/error.h"
#include "formats/random.h"
#include "modeler/union_find.h"

namespace opal {
namespace {

struct Bond {
    double random;
    NeighbourPair pair;

    auto operator<=>(const Bond&) const = default;
};

/// All bonds, the first to be kept first.
std::vector<Bond> bonds_in_order(const NeighbourGraph& graph, std::uint64_t seed) {
    std::vector<Bond> bonds;
    bonds.reserve(graph.size());
    for (const NeighbourPair& pair : graph) {
        const std::uint64_t index =
            (static_cast<std::uint64_t>(pair.first) << 32) | static_cast<std::uint64_t>(static_cast<std::uint32_t>(pair.second));
        const RandomBlock block = random_block(seed, RandomStream::sintering_bonds, index, 0);
        bonds.push_back({uniform_double(block.value[0], block.value[1]), pair});
    }
    std::sort(bonds.begin(), bonds.end());
    return bonds;
}

struct Sweep {
    std::size_t fewest_grains = 0;                ///< with all bonds kept
    std::optional<std::size_t> bonds_for_target;  ///< how many bonds leave exactly the target
    std::optional<double> threshold;
};

/// Adds bond after bond, following the number of grains and the mean size of all but the largest.
Sweep sweep_bonds(const std::vector<Bond>& bonds, std::size_t num_sites, std::size_t num_visible, std::size_t target) {
    UnionFind clusters(num_sites);
    Sweep sweep;
    sweep.fewest_grains = num_visible;
    if (target == num_visible) sweep.bonds_for_target = 0;
    double sum_of_squares = static_cast<double>(num_visible);
    double highest_mean = 0.0;
    std::size_t largest = 1;
    for (std::size_t n = 0; n < bonds.size(); ++n) {
        const std::size_t a = clusters.root(static_cast<std::size_t>(bonds[n].pair.first));
        const std::size_t b = clusters.root(static_cast<std::size_t>(bonds[n].pair.second));
        if (a == b) continue;
        sum_of_squares += 2.0 * static_cast<double>(clusters.size_at(a)) * static_cast<double>(clusters.size_at(b));
        largest = std::max(largest, clusters.join(a, b));
        if (--sweep.fewest_grains == target) sweep.bonds_for_target = n + 1;
        const double mean_of_others = sum_of_squares - static_cast<double>(largest) * static_cast<double>(largest);
        if (mean_of_others > highest_mean) {
            highest_mean = mean_of_others;
            sweep.threshold = static_cast<double>(n + 1) / static_cast<double>(bonds.size());
        }
    }
    return sweep;
}

std::size_t count_kept(const std::vector<Bond>& bonds, const SinteringRecipe& recipe, const Sweep& sweep,
                       std::size_t num_visible) {
    if (recipe.target_grains > 0) {
        if (sweep.bonds_for_target) return *sweep.bonds_for_target;
        throw InputError(fmt::format("grains.sintering.grains = {} cannot be reached: these {} sites can form {} to {} grains",
                                     recipe.target_grains, num_visible, sweep.fewest_grains, num_visible));
    }
    const auto end =
        std::partition_point(bonds.begin(), bonds.end(), [&](const Bond& bond) { return bond.random < recipe.probability; });
    return static_cast<std::size_t>(end - bonds.begin());
}

void number_grains(UnionFind& clusters, const std::vector<char>& hidden, Sintering& result) {
    std::vector<std::int32_t> grain_of_root(hidden.size(), 0);
    result.grain_of_site.assign(hidden.size(), 0);
    for (std::size_t site = 0; site < hidden.size(); ++site) {
        if (hidden[site] != 0) continue;
        std::int32_t& grain = grain_of_root[clusters.root(site)];
        if (grain == 0) grain = ++result.num_grains;
        result.grain_of_site[site] = grain;
    }
}

}  // namespace

Sintering sinter(const NeighbourGraph& graph, const std::vector<char>& hidden, const SinteringRecipe& recipe,
                 std::uint64_t seed) {
    const auto num_visible = static_cast<std::size_t>(std::count(hidden.begin(), hidden.end(), char(0)));
    const std::vector<Bond> bonds = bonds_in_order(graph, seed);
    const Sweep sweep = sweep_bonds(bonds, hidden.size(), num_visible, static_cast<std::size_t>(recipe.target_grains));

    Sintering result;
    result.threshold = sweep.threshold;
    result.num_kept_bonds = count_kept(bonds, recipe, sweep, num_visible);
    result.probability = recipe.target_grains == 0 ? recipe.probability
                         : bonds.empty()           ? 0.0
                                         : static_cast<double>(result.num_kept_bonds) / static_cast<double>(bonds.size());
    UnionFind clusters(hidden.size());
    std::size_t largest = num_visible > 0 ? 1 : 0;
    for (std::size_t n = 0; n < result.num_kept_bonds; ++n) {
        const std::size_t a = clusters.root(static_cast<std::size_t>(bonds[n].pair.first));
        const std::size_t b = clusters.root(static_cast<std::size_t>(bonds[n].pair.second));
        if (a != b) largest = std::max(largest, clusters.join(a, b));
    }
    result.largest_grain_fraction = static_cast<double>(largest) / static_cast<double>(std::max<std::size_t>(1, num_visible));
    number_grains(clusters, hidden, result);
    return result;
}

}  // namespace opal
