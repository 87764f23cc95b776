// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "formats/opal_asset.h"
#include "modeler/neighbour_graph.h"

namespace opal {

/// Counts of values between edges: count[k] lies in [edge[k], edge[k + 1]).
struct Histogram {
    std::vector<double> edge;
    std::vector<std::uint64_t> count;
};

/// Mean, standard deviation and order statistics of a set of numbers; all 0 for an empty one.
struct Spread {
    double mean = 0.0, std = 0.0, min = 0.0, median = 0.0, max = 0.0;
};

/// How large an opal's grains are and how their lattices lie to each other.
struct GrainStatistics {
    bool has_volumes = false;                 ///< volumes and diameters are known: the opal has voxels
    std::uint64_t grains_without_voxels = 0;  ///< outside the shape, or smaller than a voxel; not in the two spreads
    Spread volume_mm3;
    Spread diameter_mm;            ///< of balls of the grains' volumes
    Histogram diameter_histogram;  ///< in 20 bins of equal ratio, from the smallest to the largest
    Spread sites_per_grain;
    Histogram sites_histogram;                    ///< in bins 1, 2 to 3, 4 to 7, ...
    std::uint64_t neighbouring_grains = 0;        ///< pairs of grains with a bond between their sites
    Spread misorientation_deg;                    ///< of those pairs
    Histogram misorientation_histogram;           ///< in bins of 2 degrees
    std::vector<double> misorientation_expected;  ///< Mackenzie's part of pairs per bin, for uniformly random lattices
};

/// Voxels of each grain of 1 to `num_grains`, in that order. Counted leaf by leaf on all threads.
std::vector<std::uint64_t> voxels_per_grain(const openvdb::Int32Grid& grain_id, std::size_t num_grains);

/// Statistics of the asset's labels, sites and orientations; `graph` says which sites neighbour each other.
GrainStatistics grain_statistics(const OpalAsset& asset, const NeighbourGraph& graph);

nlohmann::json grain_statistics_to_json(const GrainStatistics& statistics);

}  // namespace opal
