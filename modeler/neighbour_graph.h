// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <compare>
#include <cstdint>
#include <vector>

#include "formats/opal_asset.h"
#include "modeler/shape.h"

namespace opal {

/// Two neighbouring sites by index, first < second.
struct NeighbourPair {
    std::int32_t first;
    std::int32_t second;

    auto operator<=>(const NeighbourPair&) const = default;
};

/// Ascending, without repetition; hidden sites have no neighbours.
using NeighbourGraph = std::vector<NeighbourPair>;

/// Smallest cube of the search, as a part of the sites' mean spacing: measured, halving it finds less than one more pair in a
/// thousand.
inline constexpr double smallest_face_search = 1.0 / 128.0;

/// The true neighbours of the weighted diagram inside the shape: pairs of cells that share a piece of face there, in the metric
/// of `kind`, any boundary noise disregarded.
///
/// A pair is taken only on proof: a point inside the shape where both sites are equally near (to 1e-9 spacings) and every other
/// one is farther. So no pair is ever wrong. Every pair is found whose face holds, inside the shape, a disk of radius twice
/// `smallest_face_search` spacings; smaller faces may be missed. Cells of additive weights are settled one by one where possible
/// (RadialCell); what that leaves, and the other metrics, by dividing space (FaceSearch). The result does not depend on threads.
/// Throws Interrupted on Ctrl-C. `cubes_looked_at`, where given, is raised by the cubes that the division of space came to: what
/// the search costs, on any machine.
NeighbourGraph apollonius_graph(const std::vector<Site>& sites, const std::vector<char>& hidden, const Shape& shape,
                                double spacing_mm, TessellationKind kind = TessellationKind::additive,
                                std::atomic<std::uint64_t>* cubes_looked_at = nullptr);

/// Edges of the Delaunay tetrahedrization of the visible sites, weights and shape disregarded (CGAL, exact predicates). Includes
/// the long edges along the sites' convex hull. Sites on a line or in a plane are joined as their Delaunay triangulation there
/// joins them; sites at the very same place are neighbours, and the lowest of them has the others' further neighbours. Where five
/// or more sites lie on one empty sphere, CGAL's symbolic perturbation chooses; that depends on the positions alone.
NeighbourGraph delaunay_graph(const std::vector<Site>& sites, const std::vector<char>& hidden);

/// Neighbours on a lattice: visible sites whose cells, one per site and no two alike, differ by one step along one axis; up to
/// six per site.
NeighbourGraph lattice_graph(const std::vector<openvdb::Coord>& cells, const std::vector<char>& hidden);

}  // namespace opal
