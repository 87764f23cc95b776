// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>
#include <openvdb/points/PointDataGrid.h>

#include <string>

#include "formats/opal_asset.h"

namespace opal {

/// The sites as points. Positions in P are 32-bit offsets in a voxel, which moves a site by up to some 1e-8 of the sites'
/// distance and with it the owner of voxels that lie that close to a boundary; the attribute `position_mm` therefore holds them
/// exactly.
openvdb::points::PointDataGrid::Ptr sites_to_points(const OpalAsset& asset);

/// Sets the asset's sites and orientations. Where P is off `position_mm` by more than P's rounding, another program has moved the
/// site, and P is taken. Throws InputError for missing attributes, ids and grains out of range, grains without an orientation.
void read_sites(const openvdb::points::PointDataGrid& grid, OpalAsset& asset, std::size_t num_grains, const std::string& file);

/// The largest grain that a site belongs to.
std::size_t count_grains_of_sites(const openvdb::points::PointDataGrid& grid, const std::string& file);

}  // namespace opal
