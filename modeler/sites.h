// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <string>
#include <vector>

#include "modeler/shape.h"

namespace opal {

/// Where grains grow from, and how evenly that is spread.
struct SiteSet {
    std::vector<openvdb::Vec3d> positions_mm;
    std::vector<openvdb::Coord> lattice_cells;  ///< jittered lattice: the cell of each site, from 0; else empty
    double shape_volume_mm3 = 0.0;              ///< estimated by sampling, standard error at most 1 %
    double region_volume_mm3 = 0.0;             ///< of what the sites fill: the shape, its bounds or the cells; of a file's
                                                ///< sites: what as many would fill at the density inside the shape
    double shortest_distance_mm = 0.0;          ///< between any two distinct sites; 0 for a single one
    double relative_radius = 0.0;               ///< that, over the distance in the densest packing; Poisson disk: 0.68 to 0.71
    std::size_t duplicates = 0;                 ///< sites at the very place of an earlier one
    std::vector<std::string> warnings;

    /// Edge of a cube of a site's share of the volume.
    double spacing_mm() const;
};

/// The recipe's sites.
///
/// Poisson disk: exactly num_sites, in the shape or in its bounds. Candidates, five per site, are uniform there; sample
/// elimination picks among them. Jittered lattice: see lattice_sites. File: see read_site_file; num_sites plays no role. A file's
/// sites may lie outside the shape and at the same place, which is counted in the warnings where they are farther outside its
/// bounds than a site's spacing; it is an error if all are.
///
/// Everything is a function of shape, recipe and seed alone. Throws InputError where the shape cannot be sampled
/// (sample_uniformly) or the file not used.
SiteSet sample_sites(const Shape& shape, const GrainsRecipe& grains);

/// Poisson-disk sites inside the shape.
SiteSet sample_sites(const Shape& shape, std::size_t count, std::uint64_t seed);

}  // namespace opal
