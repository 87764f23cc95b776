// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <string>
#include <utility>
#include <vector>

#include "formats/opal_asset.h"

namespace opal {

/// The values of a field, in its own unit.
struct FieldSummary {
    float min = 0.0f;
    float max = 0.0f;
    double mean = 0.0;  ///< over the volume of the shape
};

/// Smallest and largest active value, and the mean over the active voxels whose centres lie inside the level set (a tile counts
/// by its middle). Without a level set, or where no voxel lies inside, the mean is over all active voxels.
FieldSummary summarize_field(const openvdb::FloatGrid& field, const openvdb::FloatGrid::ConstPtr& shape);

/// The coefficients of an opal that vary, by the names of their grids, in the file's order.
std::vector<std::pair<std::string, openvdb::FloatGrid::ConstPtr>> varying_coefficients(const OpalAsset& asset);

}  // namespace opal
