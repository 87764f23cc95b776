// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

namespace opal {

/// Ids up to here are told apart by a float.
inline constexpr std::int32_t largest_id_in_float = 1 << 24;

/// grain_id_float: grain_id as floats, tiles kept, for clients that have no integer grids.
openvdb::FloatGrid::Ptr make_grain_id_float(const openvdb::Int32Grid& grain_id);

/// orientation_rgb: each voxel's grain in its display colour (grain_display_color), tiles kept.
openvdb::Vec3SGrid::Ptr make_orientation_rgb(const openvdb::Int32Grid& grain_id);

}  // namespace opal
