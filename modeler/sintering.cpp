// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/sintering.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/error.h"
#include "formats/units.h"
#include "modeler/bond_order.h"

namespace opal {
namespace {

struct Sweep {
    std::size_t num_visible = 0;
    std::size_t fewest_grains = 0;               ///< with all bonds kept
    std::optional<std::size_t> kept_for_target;  ///< how many bonds leave exactly the target
    std::optional<double> threshold;
};

Sweep sweep_to_target(const BondOrder& bonds, const std::vector<char>& hidden, std::size_t target) {
    Sweep sweep;
    sweep.num_visible = static_cast<std::size_t>(std::count(hidden.begin(), hidden.end(), char(0)));
    ThresholdFinder finder;
    sweep_bonds(bonds, hidden.size(), sweep.num_visible, [&](const BondSweepState& state) {
        finder.visit(state, sweep.num_visible);
        if (state.num_grains == target && !sweep.kept_for_target) sweep.kept_for_target = state.num_kept;
        sweep.fewest_grains = state.num_grains;
    });
    sweep.threshold = finder.threshold(bonds);
    return sweep;
}

double mean_ball_diameter_mm(double volume_mm3, std::size_t num_grains) {
    return std::cbrt(6.0 * volume_mm3 / (units::pi * static_cast<double>(std::max<std::size_t>(1, num_grains))));
}

/// The number of grains that the recipe wants; 0 where it gives a probability instead. Beyond what an integer holds: SIZE_MAX.
std::size_t target_grains(const SinteringRecipe& recipe, double volume_mm3) {
    if (recipe.target_grains > 0 || recipe.mean_grain_mm <= 0.0) return static_cast<std::size_t>(recipe.target_grains);
    const double diameter_mm = recipe.mean_grain_mm;
    const double grains = std::round(volume_mm3 / (units::pi / 6.0 * diameter_mm * diameter_mm * diameter_mm));
    return grains < 1.0e15 ? std::max<std::size_t>(1, static_cast<std::size_t>(grains)) : SIZE_MAX;
}

[[noreturn]] void throw_unreachable(const SinteringRecipe& recipe, const Sweep& sweep, double volume_mm3) {
    const std::string possible =
        fmt::format("these {} sites can form {} to {} grains", sweep.num_visible, sweep.fewest_grains, sweep.num_visible);
    if (recipe.target_grains > 0)
        throw InputError(fmt::format("grains.sintering.grains = {} cannot be reached: {}", recipe.target_grains, possible));
    throw InputError(fmt::format("grains.sintering.mean_grain_mm = {:.4g} cannot be reached: {}, {:.4g} to {:.4g} mm across",
                                 recipe.mean_grain_mm, possible, mean_ball_diameter_mm(volume_mm3, sweep.num_visible),
                                 mean_ball_diameter_mm(volume_mm3, sweep.fewest_grains)));
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

Sintering sinter(const NeighbourGraph& graph, const std::vector<char>& hidden, const SinteringRecipe& recipe, std::uint64_t seed,
                 const std::vector<double>& bond_weights, double sites_volume_mm3) {
    const BondOrder bonds(graph, bond_weights, seed);
    const std::size_t target = target_grains(recipe, sites_volume_mm3);
    const Sweep sweep = sweep_to_target(bonds, hidden, target);
    if (target > 0 && !sweep.kept_for_target) throw_unreachable(recipe, sweep, sites_volume_mm3);

    Sintering result;
    result.threshold = sweep.threshold;
    result.num_kept_bonds = target > 0 ? *sweep.kept_for_target : bonds.num_kept(recipe.probability);
    result.probability = target > 0 ? bonds.probability(result.num_kept_bonds) : recipe.probability;
    UnionFind clusters(hidden.size());
    std::size_t largest = sweep.num_visible > 0 ? 1 : 0;
    for (std::size_t n = 0; n < result.num_kept_bonds; ++n) {
        const std::size_t a = clusters.root(static_cast<std::size_t>(bonds[n].first));
        const std::size_t b = clusters.root(static_cast<std::size_t>(bonds[n].second));
        if (a != b) largest = std::max(largest, clusters.join(a, b));
    }
    result.largest_grain_fraction =
        static_cast<double>(largest) / static_cast<double>(std::max<std::size_t>(1, sweep.num_visible));
    number_grains(clusters, hidden, result);
    return result;
}

}  // namespace opal
