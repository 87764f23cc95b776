// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "formats/error.h"
#include "formats/opal_asset.h"
#include "formats/opal_asset_io.h"

namespace opal {
namespace {

void check_grain_ids(const OpalAsset& asset, AssetCheck& check) {
    std::vector<bool> seen(asset.num_grains() + 1, false);
    const openvdb::math::Transform& shape_transform = asset.shape->transform();
    auto shape = asset.shape->getConstAccessor();
    std::size_t outside = 0;
    const double slack_mm = asset.grain_id->voxelSize().x();
    for (auto value = asset.grain_id->cbeginValueOn(); value; ++value) {
        seen[std::size_t(*value)] = true;
        if (value.isTileValue()) continue;
        const openvdb::Vec3d world = asset.grain_id->indexToWorld(value.getCoord());
        const openvdb::Coord index = openvdb::Coord::round(shape_transform.worldToIndex(world));
        if (shape.getValue(index) > slack_mm) ++outside;
    }
    if (outside > 0) check.errors.push_back(fmt::format("grid grain_id: {} voxels lie outside the shape", outside));
    const auto unseen = std::count(seen.begin() + 1, seen.end(), false);
    if (unseen > 0)
        check.advice.push_back(fmt::format("grid grain_id: {} of {} grains hold no voxel: finer voxels would show them", unseen,
                                           asset.num_grains()));
    if (asset.grain_id->tree().leafCount() == 0)
        check.advice.push_back("grid grain_id: tiles only, no leaf: Blender shows such a grid as empty");
}

void check_sites(const OpalAsset& asset, AssetCheck& check) {
    std::size_t broken = 0;
    for (const Site& site : asset.sites)
        if (!std::isfinite(site.position_mm.lengthSqr()) || !std::isfinite(site.weight_mm)) ++broken;
    if (broken > 0) check.errors.push_back(fmt::format("grid sites: {} sites have NaN positions or weights", broken));
}

void check_order(const RawOpalFile& raw, AssetCheck& check) {
    if (raw.find(grid_names::sites) && raw.grids.back()->getName() != grid_names::sites)
        check.advice.push_back("grid sites should be last: NanoVDB's converter stops at it");
}

}  // namespace

AssetCheck check_opal_asset(const std::filesystem::path& path) {
    AssetCheck check;
    const RawOpalFile raw = read_raw_opal_file(path);
    try {
        const OpalAsset asset = asset_from_raw(raw, path.string(), {}, check.advice);
        check_grain_ids(asset, check);
        check_sites(asset, check);
        check_order(raw, check);
    } catch (const InputError& error) {
        check.errors.push_back(error.what());
    }
    return check;
}

}  // namespace opal
