// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "formats/opal_asset.h"
#include "formats/recipe.h"
#include "modeler/neighbour_graph.h"
#include "modeler/shape.h"
#include "modeler/sites.h"
#include "modeler/stage_runner.h"

namespace opal {

/// Weighted sites and who neighbours whom: what grains grow on.
struct SiteNetwork {
    SiteSet site_set;
    std::vector<Site> sites;              ///< with weights, not yet with grains
    double weight_scale = 1.0;            ///< factor by which grains.limit_weights reduced the weights
    openvdb::FloatGrid::Ptr weight_grid;  ///< the field behind them, where output.grids asks for it
    std::vector<char> hidden;             ///< per site, 1 where it owns nothing
    NeighbourGraph graph;
    std::vector<double> contact_areas_mm2;  ///< of the graph's pairs, where sintering prefers large contacts; else empty

    std::size_t num_visible() const;
    /// Neighbours per visible site; 0 where none is visible.
    double mean_degree() const;
};

/// The stages sites, weights, hidden_sites, neighbour_graph and, where they are needed, contact_areas of a recipe.
SiteNetwork make_site_network(const Recipe& recipe, const Shape& shape, StageRunner& stages);

}  // namespace opal
