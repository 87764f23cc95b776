// SPDX-License-Identifier: Apache-2.0
#include "formats/opal_asset_sites.h"

#include <fmt/format.h>
#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointCount.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "formats/error.h"

namespace opal {
namespace {

using Quat = openvdb::math::Quat<float>;

/// OpenVDB takes transforms with voxels below 1.44e-5 for singular.
constexpr double min_point_voxel_mm = 2.0e-5;
/// Voxels are counted in 32 bits; so many from the origin leave room.
constexpr double max_point_voxels_per_axis = 0x1p20;
/// Relative to the distance between sites and from the origin: more than the rounding of 32-bit positions, far below what an
/// artist moves.
constexpr double moved_by_hand = 1.0e-6;

/// Edge of a cube of a site's share of the sites' bounds, one site per voxel on average; a plane of sites counts as a thin plate.
double site_spacing_mm(const std::vector<Site>& sites) {
    openvdb::BBoxd box;
    for (const Site& site : sites) box.expand(site.position_mm);
    const openvdb::Vec3d extents_mm = box.extents();
    const double longest_mm = std::max({extents_mm.x(), extents_mm.y(), extents_mm.z()});
    if (!(longest_mm > 0.0)) return 1.0;
    double volume_mm3 = 1.0;
    for (int axis = 0; axis < 3; ++axis) volume_mm3 *= std::max(extents_mm[axis], 1.0e-3 * longest_mm);
    return std::cbrt(volume_mm3 / double(sites.size()));
}

double point_voxel_size_mm(const std::vector<Site>& sites) {
    double farthest_mm = 0.0;
    for (const Site& site : sites) farthest_mm = std::max(farthest_mm, site.position_mm.length());
    return std::max({site_spacing_mm(sites), farthest_mm / max_point_voxels_per_axis, min_point_voxel_mm});
}

template <typename Value>
void fill_attribute(openvdb::points::PointDataTree& tree, const std::string& name,
                    const std::function<Value(std::int32_t id)>& of) {
    openvdb::points::appendAttribute<Value>(tree, name);
    for (auto leaf = tree.beginLeaf(); leaf; ++leaf) {
        const openvdb::points::AttributeHandle<std::int32_t> id(leaf->constAttributeArray("id"));
        openvdb::points::AttributeWriteHandle<Value> attribute(leaf->attributeArray(name));
        for (openvdb::Index i = 0; i < id.size(); ++i) attribute.set(i, of(id.get(i)));
    }
}

void require_attributes(const openvdb::points::PointDataTree::LeafNodeType& leaf, const std::string& file) {
    for (const char* name : {"P", "id", "grain", "weight", "orient"})
        if (!leaf.hasAttribute(name)) throw InputError(fmt::format("{}: grid sites: attribute '{}' is missing", file, name));
}

void require_unit_orientations(const std::vector<Quat>& orientations, const std::string& file) {
    for (std::size_t i = 0; i < orientations.size(); ++i) {
        const Quat& q = orientations[i];
        const double norm = std::sqrt(double(q[0]) * q[0] + double(q[1]) * q[1] + double(q[2]) * q[2] + double(q[3]) * q[3]);
        if (!(std::abs(norm - 1.0) < 1.0e-3))
            throw InputError(fmt::format("{}: grid sites: grain {} has no unit orientation (norm {:.4g})", file, i + 1, norm));
    }
}

}  // namespace

openvdb::points::PointDataGrid::Ptr sites_to_points(const OpalAsset& asset) {
    namespace points = openvdb::points;
    std::vector<openvdb::Vec3d> positions;
    std::vector<std::int32_t> ids;
    for (const Site& site : asset.sites) {
        positions.push_back(site.position_mm);
        ids.push_back(static_cast<std::int32_t>(ids.size()) + 1);
    }
    const points::PointAttributeVector<openvdb::Vec3d> position_list(positions);
    const auto transform = openvdb::math::Transform::createLinearTransform(point_voxel_size_mm(asset.sites));
    const auto index_grid = openvdb::tools::createPointIndexGrid<openvdb::tools::PointIndexGrid>(position_list, *transform);
    auto grid = points::createPointDataGrid<points::NullCodec, points::PointDataGrid>(*index_grid, position_list, *transform);
    const points::PointAttributeVector<std::int32_t> id_list(ids);
    points::appendAttribute<std::int32_t>(grid->tree(), "id");
    points::populateAttribute(grid->tree(), index_grid->tree(), "id", id_list);

    const auto site = [&](std::int32_t id) -> const Site& { return asset.sites[std::size_t(id) - 1]; };
    const float pscale = float(0.25 * site_spacing_mm(asset.sites));
    fill_attribute<std::int32_t>(grid->tree(), "grain", [&](std::int32_t id) { return site(id).grain; });
    fill_attribute<float>(grid->tree(), "weight", [&](std::int32_t id) { return site(id).weight_mm; });
    fill_attribute<float>(grid->tree(), "pscale", [&](std::int32_t) { return pscale; });
    fill_attribute<openvdb::Vec3f>(grid->tree(), "Cd", [&](std::int32_t id) { return grain_display_color(site(id).grain); });
    fill_attribute<Quat>(grid->tree(), "orient", [&](std::int32_t id) {
        return site(id).grain > 0 ? asset.grain_orientations[std::size_t(site(id).grain) - 1] : Quat(0.0f, 0.0f, 0.0f, 1.0f);
    });
    fill_attribute<openvdb::Vec3d>(grid->tree(), "position_mm", [&](std::int32_t id) { return site(id).position_mm; });
    grid->setName(grid_names::sites);
    return grid;
}

void read_sites(const openvdb::points::PointDataGrid& grid, OpalAsset& asset, std::size_t num_grains, const std::string& file) {
    namespace points = openvdb::points;
    const std::size_t count = points::pointCount(grid.tree());
    const double voxel_size_mm = grid.voxelSize().x();
    asset.sites.assign(count, Site{});
    asset.grain_orientations.assign(num_grains, Quat(0.0f, 0.0f, 0.0f, 0.0f));
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        require_attributes(*leaf, file);
        const points::AttributeHandle<openvdb::Vec3f> offset(leaf->constAttributeArray("P"));
        const points::AttributeHandle<std::int32_t> id(leaf->constAttributeArray("id")),
            grain(leaf->constAttributeArray("grain"));
        const points::AttributeHandle<float> weight(leaf->constAttributeArray("weight"));
        const points::AttributeHandle<Quat> orient(leaf->constAttributeArray("orient"));
        points::AttributeHandle<openvdb::Vec3d>::Ptr exact;
        if (leaf->hasAttribute("position_mm"))
            exact = points::AttributeHandle<openvdb::Vec3d>::create(leaf->constAttributeArray("position_mm"));
        for (auto index = leaf->beginIndexOn(); index; ++index) {
            const std::int32_t site_id = id.get(*index), grain_id = grain.get(*index);
            if (site_id < 1 || std::size_t(site_id) > count || grain_id < 0 || std::size_t(grain_id) > num_grains)
                throw InputError(fmt::format("{}: grid sites: site {} of {} in grain {} of {} is out of range", file, site_id,
                                             count, grain_id, num_grains));
            Site& site = asset.sites[std::size_t(site_id) - 1];
            site.position_mm = grid.indexToWorld(openvdb::Vec3d(offset.get(*index)) + index.getCoord().asVec3d());
            if (exact) {
                const openvdb::Vec3d position_mm = exact->get(*index);
                const double rounding_mm = moved_by_hand * (voxel_size_mm + position_mm.length());
                if ((position_mm - site.position_mm).length() <= rounding_mm) site.position_mm = position_mm;
            }
            site.weight_mm = weight.get(*index);
            site.grain = grain_id;
            if (grain_id > 0) asset.grain_orientations[std::size_t(grain_id) - 1] = orient.get(*index);
        }
    }
    require_unit_orientations(asset.grain_orientations, file);
}

std::size_t count_grains_of_sites(const openvdb::points::PointDataGrid& grid, const std::string& file) {
    std::int32_t largest = 0;
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        require_attributes(*leaf, file);
        const openvdb::points::AttributeHandle<std::int32_t> grain(leaf->constAttributeArray("grain"));
        for (auto index = leaf->beginIndexOn(); index; ++index) largest = std::max(largest, grain.get(*index));
    }
    return std::size_t(largest);
}

}  // namespace opal
