// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "formats/error.h"
#include "formats/opal_asset.h"
#include "formats/opal_asset_io.h"
#include "formats/text.h"

namespace opal {
namespace {

void check_grain_ids(const OpalAsset& asset, AssetCheck& check) {
    if (!asset.grain_id) {
        check.advice.push_back(
            "no grid grain_id: sites alone; opal-render shows the cells of additive and Voronoi sites where there is a shape; "
            "build with "
            "[output] grids = [\"grain_id\", \"shape\", \"sites\"] for other clients");
        return;
    }
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

/// A field must have a value wherever there is opal.
void check_field(const OpalAsset& asset, const openvdb::FloatGrid::Ptr& field, const char* name, AssetCheck& check) {
    if (!field || !asset.grain_id) return;
    auto values = field->getConstAccessor();
    std::size_t uncovered = 0;
    for (auto voxel = asset.grain_id->cbeginValueOn(); voxel; ++voxel) {
        const openvdb::Vec3d world = asset.grain_id->indexToWorld(voxel.getCoord());
        if (!values.isValueOn(openvdb::Coord::round(field->worldToIndex(world)))) ++uncovered;
    }
    if (uncovered > 0)
        check.errors.push_back(
            fmt::format("grid {}: has no value at {} of grain_id's voxels, where its background {} would stand", name, uncovered,
                        field->background()));
}

/// Twins show what grain_id holds, or they mislead.
void check_twins(const RawOpalFile& raw, const OpalAsset& asset, AssetCheck& check) {
    const auto wrong_type = [&](const char* name, const openvdb::GridBase::Ptr& grid, const char* allowed) {
        check.errors.push_back(fmt::format("grid {} has type {}; allowed: {}", name, grid->valueType(), allowed));
    };
    if (const auto colors = raw.find(grid_names::orientation_rgb); colors && !openvdb::gridPtrCast<openvdb::Vec3SGrid>(colors))
        wrong_type(grid_names::orientation_rgb, colors, "vec3s");
    const auto base = raw.find(grid_names::grain_id_float);
    if (!base || !asset.grain_id) return;
    const auto twin = openvdb::gridPtrCast<openvdb::FloatGrid>(base);
    if (!twin) {
        wrong_type(grid_names::grain_id_float, base, "float");
        return;
    }
    auto twin_ids = twin->getConstAccessor();
    std::size_t different = twin->activeVoxelCount() == asset.grain_id->activeVoxelCount() ? 0 : 1;
    for (auto id = asset.grain_id->cbeginValueOn(); id; ++id)
        if (twin_ids.getValue(id.getCoord()) != static_cast<float>(*id)) ++different;
    if (different > 0) check.errors.push_back(fmt::format("grid {}: differs from grain_id", grid_names::grain_id_float));
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

void check_names(const RawOpalFile& raw, AssetCheck& check) {
    const std::vector<std::string> known = {grid_names::grain_id,
                                            grid_names::shape,
                                            grid_names::weight,
                                            grid_names::sigma_a_scale,
                                            grid_names::sigma_s_rayleigh,
                                            grid_names::sigma_s_mie,
                                            grid_names::orientation_rgb,
                                            grid_names::grain_id_float,
                                            grid_names::sites};
    for (const auto& grid : raw.grids)
        if (std::find(known.begin(), known.end(), grid->getName()) == known.end())
            check.advice.push_back(fmt::format("grid {} is not part of an opal and is left alone{}", grid->getName(),
                                               did_you_mean(grid->getName(), known)));
}

}  // namespace

AssetCheck check_opal_asset(const std::filesystem::path& path) {
    AssetCheck check;
    const RawOpalFile raw = read_raw_opal_file(path);
    try {
        const OpalAsset asset = asset_from_raw(raw, path.string(), {}, check.advice);
        check_grain_ids(asset, check);
        check_sites(asset, check);
        check_field(asset, asset.sigma_a_scale, grid_names::sigma_a_scale, check);
        check_field(asset, asset.sigma_s_rayleigh_400nm, grid_names::sigma_s_rayleigh, check);
        check_field(asset, asset.sigma_s_mie, grid_names::sigma_s_mie, check);
        check_twins(raw, asset, check);
        check_order(raw, check);
        check_names(raw, check);
    } catch (const InputError& error) {
        check.errors.push_back(error.what());
    }
    return check;
}

}  // namespace opal
