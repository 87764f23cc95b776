// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace opal {

/// One way of finding the grains along rays through one set of sites.
struct GrainsBenchRow {
    std::string weights;  ///< additive: a noise, as by default; voronoi: none; nearly-equal: up to 1e-5 mm; strong: many hidden
    std::size_t sites = 0;
    std::string method;           ///< cells, sphere-tracing, hyperboloid, voxels
    int voxels_across = 0;        ///< voxels: along the ball's diameter
    double ns_per_grain = 0;      ///< processor time per grain crossed, finding the first one included
    std::size_t bytes = 0;        ///< of what is walked
    double build_s = 0;           ///< to make that from the sites, all threads
    std::uint64_t crossings = 0;  ///< of the rays that were compared with the oracle
    std::uint64_t missed = 0, spurious = 0;
    double wrong_length = 0;   ///< part of the length that is in the wrong grain
    double mean_error_um = 0;  ///< of the distance of a crossing that was found
    double largest_error_um = 0;
};

/// Speed, memory and errors, against a long-double oracle, of every way of finding grains: chords of a ball 20 mm across, 1,000
/// and 27,000 Poisson-disk sites. One thread; some minutes, and 1.5 GB for 512^3 voxels. `quick` leaves out the 27,000 sites.
std::vector<GrainsBenchRow> bench_grains(bool quick);

}  // namespace opal
