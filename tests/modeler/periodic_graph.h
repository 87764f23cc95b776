// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <vector>

#include "modeler/neighbour_graph.h"

namespace opal::testing_tools {

/// A graph on a cube whose opposite faces are one: no site has a boundary near it.
struct PeriodicGraph {
    std::size_t num_sites = 0;
    NeighbourGraph pairs;                  ///< ascending
    std::vector<openvdb::Coord> crossing;  ///< per pair: which faces the bond crosses on its way from first to second
};

/// Delaunay graph of uniformly random (Poisson) points, so many, in the periodic unit cube: `delaunay_graph` of the points with
/// copies of those near the faces, four mean spacings deep. An empty ball reaching farther than that has a chance below 1e-50.
PeriodicGraph periodic_poisson_delaunay(std::size_t num_sites, std::uint64_t seed);

/// n x n x n sites with 6 neighbours each, periodic.
PeriodicGraph periodic_cubic_lattice(std::int32_t n);

/// The bond probabilities at which one cluster first winds around the cube along x, y and z, for one random order of the bonds
/// (J. Machta et al., "Invaded cluster algorithm for equilibrium critical points", Phys. Rev. E 54, 1996).
openvdb::Vec3d winding_probabilities(const PeriodicGraph& graph, std::uint64_t seed);

/// Estimates the bond threshold: the p where a cluster winds along a given axis with the probability that it has at the threshold
/// of any graph in three dimensions, 0.2578 (J. Wang, Z. Zhou, W. Zhang, T. M. Garoni & Y. Deng, "Bond and site percolation in
/// three dimensions", Phys. Rev. E 87, 2013). Its shift with size is far smaller than the scatter.
struct ThresholdEstimate {
    double p;
    double standard_error;  ///< cautious: the three axes of a sweep counted as one draw
};
ThresholdEstimate estimate_threshold(const PeriodicGraph& graph, int sweeps);

}  // namespace opal::testing_tools
