// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <vector>

#include "modeler/shape.h"

namespace opal {

/// Where grains grow from, and how evenly that is spread.
struct SiteSet {
    std::vector<openvdb::Vec3d> positions_mm;
    std::vector<openvdb::Coord> lattice_cells;  ///< jittered lattice: the cell of each site, no two alike; else empty
    double shape_volume_mm3 = 0.0;              ///< estimated while sampling, to about 1 %
    double shortest_distance_mm = 0.0;          ///< between any two sites; 0 for a single one
    double relative_radius = 0.0;               ///< that, over the distance in the densest packing; measured: 0.68 to 0.71

    /// Edge of a cube of a site's share of the volume.
    double spacing_mm() const;
};

/// Exactly `count` Poisson-disk sites inside the shape. Candidates, five per site, are uniform in the shape; candidate k is a
/// pure function of (seed, k). Sample elimination picks among them. Throws InputError where the shape fills too little of its
/// bounds to be sampled.
SiteSet sample_sites(const Shape& shape, std::size_t count, std::uint64_t seed);

}  // namespace opal
