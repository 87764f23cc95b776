// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <string>
#include <vector>

#include "formats/opal_asset.h"

namespace opal {

/// Everything about the asset that is not in a grid, as file metadata. Orientations are drawn from the seed, or stand with the
/// sites; where neither is so they are listed here.
openvdb::MetaMap opal_metadata(const OpalAsset& asset, bool with_sites);

/// What a file states of its grains, apart from its grids.
struct StatedGrains {
    std::size_t num_grains = 0;
    bool from_seed = true;                                 ///< orientations follow from the seed
    std::vector<openvdb::math::Quat<float>> orientations;  ///< where they are listed
};

/// Whether a file was written by this project.
bool has_opal_metadata(const openvdb::MetaMap& metadata);

/// Sets the asset's members that are not grids. Throws InputError naming file and key for what is missing, of another type or out
/// of range, and for schemas newer than ours.
StatedGrains read_opal_metadata(const openvdb::MetaMap& metadata, const std::string& file, OpalAsset& asset);

}  // namespace opal
