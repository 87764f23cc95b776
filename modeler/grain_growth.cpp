// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/grain_growth.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "formats/units.h"

namespace opal {
namespace {

/// Faces too small to be measured still are contacts.
constexpr double smallest_area_weight = 1.0e-6;

/// Contact areas over their mean, so that p keeps its meaning for the average bond.
std::vector<double> area_weights(std::vector<double> areas_mm2) {
    const double sum_mm2 = std::accumulate(areas_mm2.begin(), areas_mm2.end(), 0.0);
    const double mean_mm2 = sum_mm2 / static_cast<double>(std::max<std::size_t>(1, areas_mm2.size()));
    for (double& area : areas_mm2) area = mean_mm2 > 0.0 ? std::max(area / mean_mm2, smallest_area_weight) : 1.0;
    return areas_mm2;
}

}  // namespace

std::vector<Orientation> orientations_to_sinter_by(const Recipe& recipe, const SiteNetwork& network) {
    if (recipe.grains.sintering.preference != BondPreference::misorientation) return {};
    return site_orientations(recipe.grains.orientation, network.sites.size(), recipe.grains.seed);
}

std::vector<double> bond_weights(const Recipe& recipe, const SiteNetwork& network, const std::vector<Orientation>& of_sites) {
    switch (recipe.grains.sintering.preference) {
        case BondPreference::misorientation:
            return misorientation_weights(network.graph, of_sites,
                                          units::rad_from_deg(recipe.grains.sintering.misorientation_deg));
        case BondPreference::area:
            return area_weights(network.contact_areas_mm2);
        case BondPreference::none:
            break;
    }
    return {};
}

Sintering sinter_network(const Recipe& recipe, const SiteNetwork& network, const std::vector<double>& weights) {
    const double volume_mm3 = std::pow(network.site_set.spacing_mm(), 3.0) * static_cast<double>(network.sites.size());
    return sinter(network.graph, network.hidden, recipe.grains.sintering, recipe.grains.seed, weights, volume_mm3);
}

GrainGrowth grow_grains(const Recipe& recipe, const SiteNetwork& network, StageRunner& stages) {
    std::vector<Orientation> of_sites;
    GrainGrowth growth;
    growth.sintering = stages.run("sintering", [&] {
        of_sites = orientations_to_sinter_by(recipe, network);
        return sinter_network(recipe, network, bond_weights(recipe, network, of_sites));
    });
    growth.grain_orientations = stages.run("orientations", [&] {
        return of_sites.empty() ? grain_orientations(recipe.grains.orientation, growth.sintering.num_grains, recipe.grains.seed)
                                : orientations_of_grains(of_sites, growth.sintering);
    });
    return growth;
}

}  // namespace opal
