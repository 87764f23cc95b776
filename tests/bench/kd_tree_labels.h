// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <vector>

#include "formats/opal_asset.h"

namespace opal {

/// What a k-d tree makes of labelling, on a part of the voxels.
struct KdTreeLabels {
    double seconds = 0.0;
    std::uint64_t voxels = 0;       ///< that were asked about
    std::uint64_t differences = 0;  ///< whose label is not the grid's
};

/// Asks a k-d tree (nanoflann) for the owner of each voxel in every `stride`-th leaf of `labels`, on all threads. Exact in the
/// additively weighted distance: more and more of the nearest sites are fetched until none beyond them can own the voxel. With
/// `weights_count` false one nearest neighbour per voxel is all that is asked, the least that any such tree could do; labels then
/// differ.
KdTreeLabels label_by_kd_tree(const std::vector<Site>& sites, const std::vector<std::int32_t>& label_of_site,
                              const openvdb::Int32Grid& labels, std::size_t stride, bool weights_count);

}  // namespace opal
