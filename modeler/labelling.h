// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <vector>

#include "formats/opal_asset.h"

namespace opal {

/// Labels every voxel whose centre is inside the shape (level set value below 0) with `label_of_site` of the site that owns the
/// centre: the smallest delta_i(x) = |x - p_i| - w_i in mm, ties going to the lowest index. Sites with label 0 take no part.
/// Voxels outside are inactive with value 0. Equal, voxel for voxel, to a search through all sites, and independent of the number
/// of threads.
///
/// Blocks of 128 down to 4 voxels are visited with candidate lists that shrink on the way (SiteCulling); a block whose candidates
/// share a label becomes tiles at once. At least one leaf is real, which Blender needs. The grid has the level set's transform,
/// whose voxel centres must be at integer multiples of the voxel size. Throws Interrupted on Ctrl-C.
openvdb::Int32Grid::Ptr label_voxels(const std::vector<Site>& sites, const std::vector<std::int32_t>& label_of_site,
                                     const openvdb::FloatGrid& shape_level_set);

}  // namespace opal
