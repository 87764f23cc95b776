// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <vector>

#include "formats/opal_asset.h"
#include "formats/recipe.h"

namespace opal {

/// What decides whose a place is, beside the sites.
struct Tessellation {
    TessellationKind kind = TessellationKind::additive;
    BoundaryNoiseRecipe boundary_noise;
    std::uint64_t seed = 0;  ///< of the boundary noise
};

/// Labels every voxel whose centre x is inside the shape (level set value below 0) with `label_of_site` of the site that owns the
/// centre: the smallest delta_i(x) (TessellationMetric), of delta_i(x + d(x)) where boundary noise displaces x (BoundaryNoise);
/// ties go to the lowest index. Sites with label 0 take no part. Voxels outside are inactive with value 0; the shape itself is
/// not displaced. Equal, voxel for voxel, to a search through all sites, and independent of the number of threads.
///
/// Blocks of 128 down to 4 voxels are visited with candidate lists that shrink on the way (SiteCulling); a block whose candidates
/// share a label becomes tiles at once. At least one leaf is real, which Blender needs. The grid has the level set's transform,
/// whose voxel centres must be at integer multiples of the voxel size. Throws Interrupted on Ctrl-C.
openvdb::Int32Grid::Ptr label_voxels(const std::vector<Site>& sites, const std::vector<std::int32_t>& label_of_site,
                                     const openvdb::FloatGrid& shape_level_set, const Tessellation& tessellation = {});

}  // namespace opal
