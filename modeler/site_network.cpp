// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/site_network.h"

#include <algorithm>

#include "modeler/labelling.h"
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
    return apollonius_graph(network.sites, network.hidden, shape, network.site_set.spacing_mm());
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
    network.site_set = stages.run(
        "sites", [&] { return sample_sites(shape, static_cast<std::size_t>(recipe.grains.num_sites), recipe.grains.seed); });
    network.sites = stages.run("weights", [&] { return weigh_sites(network.site_set, recipe.grains); });
    network.hidden = stages.run("hidden_sites", [&] { return find_hidden_sites(network.sites, network.site_set.spacing_mm()); });
    network.graph = stages.run("neighbour_graph", [&] { return make_graph(recipe, shape, network); });
    return network;
}

}  // namespace opal
