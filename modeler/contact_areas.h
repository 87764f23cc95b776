// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "formats/opal_asset.h"
#include "modeler/neighbour_graph.h"
#include "modeler/shape.h"

namespace opal {

/// Area in mm^2 of the face that each pair of the graph shares inside the shape, in the graph's order. `graph` must hold the true
/// neighbours of the additively weighted diagram of `sites` (apollonius_graph).
///
/// Cells of that diagram are star-shaped about their sites. From each site 2,048 evenly spread directions (a spherical Fibonacci
/// lattice) look for the first neighbour's face, which lies at t = (|s|^2 - D^2) / (2 (u.s + D)) for the direction u, s = p_j -
/// p_i, D = w_j - w_i; a hit adds t^2 dOmega / |n.u|, n the face's normal. A face's area is the mean of what its two sites see.
/// Held by tests: squares of a cubic lattice within 1.5 %, their sum within 0.5 %, curved faces of two sites in a ball within 2
/// %; small faces are worth less, as few directions meet them. The same bits for any number of threads.
std::vector<double> contact_areas_mm2(const NeighbourGraph& graph, const std::vector<Site>& sites, const Shape& shape);

}  // namespace opal
