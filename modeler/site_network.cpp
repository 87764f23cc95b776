// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/site_network.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "modeler/contact_areas.h"
#include "modeler/hidden_sites.h"
#include "modeler/weights.h"

namespace opal {
namespace {

NeighbourGraph make_graph(const Recipe& recipe, const Shape& shape, const SiteNetwork& network) {
    switch (recipe.grains.sintering.graph) {
        case SinteringGraph::delaunay:
            return delaunay_graph(network.sites, network.hidden);
        case SinteringGraph::lattice:
            return lattice_graph(network.site_set.lattice_cells, network.hidden);
        case SinteringGraph::apollonius:
            break;
    }
    return apollonius_graph(network.sites, network.hidden, shape, network.site_set.spacing_mm(), recipe.grains.tessellation);
}

/// Gives the sites their weights, and the field behind them where the recipe asks for it.
void weigh(const Recipe& recipe, const Shape& shape, SiteNetwork& network, StageRunner& stages) {
    const GrainsRecipe& grains = recipe.grains;
    WeighedSites weighed = stages.run("weights", [&] { return weigh_sites(network.site_set, grains, shape); });
    network.sites = std::move(weighed.sites);
    network.weight_scale = weighed.weight_scale;
    if (weighed.weight_scale < 1.0)
        stages.warn(
            fmt::format("weights were multiplied by {:.4g}, so that neighbouring sites differ by less than their shortest "
                        "distance (grains.limit_weights)",
                        weighed.weight_scale));
    if (recipe.output.has(OutputGrid::weight))
        network.weight_grid =
            stages.run("weight_grid", [&] { return make_weight_grid(network.site_set, grains, shape, weighed.weight_scale); });
}

}  // namespace

std::size_t SiteNetwork::num_visible() const {
    return static_cast<std::size_t>(std::count(hidden.begin(), hidden.end(), char(0)));
}

double SiteNetwork::mean_degree() const {
    return 2.0 * static_cast<double>(graph.size()) / static_cast<double>(std::max<std::size_t>(1, num_visible()));
}

SiteNetwork make_site_network(const Recipe& recipe, const Shape& shape, StageRunner& stages) {
    SiteNetwork network;
    network.site_set = stages.run("sites", [&] { return sample_sites(shape, recipe.grains); });
    weigh(recipe, shape, network, stages);
    network.hidden = stages.run("hidden_sites", [&] { return find_hidden_sites(network.sites, recipe.grains.tessellation); });
    network.graph = stages.run("neighbour_graph", [&] { return make_graph(recipe, shape, network); });
    if (recipe.grains.sintering.preference == BondPreference::area)
        network.contact_areas_mm2 =
            stages.run("contact_areas", [&] { return contact_areas_mm2(network.graph, network.sites, shape); });
    return network;
}

}  // namespace opal
