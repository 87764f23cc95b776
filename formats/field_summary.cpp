// SPDX-License-Identifier: Apache-2.0
#include "formats/field_summary.h"

#include <algorithm>
#include <limits>

namespace opal {

FieldSummary summarize_field(const openvdb::FloatGrid& field, const openvdb::FloatGrid::ConstPtr& shape) {
    FieldSummary summary{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), 0.0};
    double inside_sum = 0.0, inside_voxels = 0.0, sum = 0.0, voxels = 0.0;
    for (auto value = field.cbeginValueOn(); value; ++value) {
        summary.min = std::min(summary.min, *value);
        summary.max = std::max(summary.max, *value);
        const double count = static_cast<double>(value.getVoxelCount());
        sum += count * static_cast<double>(*value);
        voxels += count;
        if (!shape) continue;
        openvdb::CoordBBox box;
        value.getBoundingBox(box);
        const openvdb::Vec3d middle = field.indexToWorld(0.5 * (box.min().asVec3d() + box.max().asVec3d()));
        if (shape->tree().getValue(openvdb::Coord::round(shape->worldToIndex(middle))) < 0.0f) {
            inside_sum += count * static_cast<double>(*value);
            inside_voxels += count;
        }
    }
    if (voxels == 0.0) return {field.background(), field.background(), static_cast<double>(field.background())};
    summary.mean = inside_voxels > 0.0 ? inside_sum / inside_voxels : sum / voxels;
    return summary;
}

std::vector<std::pair<std::string, openvdb::FloatGrid::ConstPtr>> varying_coefficients(const OpalAsset& asset) {
    std::vector<std::pair<std::string, openvdb::FloatGrid::ConstPtr>> fields;
    if (asset.sigma_a_scale) fields.emplace_back(grid_names::sigma_a_scale, asset.sigma_a_scale);
    if (asset.sigma_s_rayleigh_400nm) fields.emplace_back(grid_names::sigma_s_rayleigh, asset.sigma_s_rayleigh_400nm);
    if (asset.sigma_s_mie) fields.emplace_back(grid_names::sigma_s_mie, asset.sigma_s_mie);
    return fields;
}

}  // namespace opal
