// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/medium_fields.h"

#include <algorithm>
#include <cmath>

#include "formats/field_summary.h"
#include "formats/units.h"

namespace opal {
namespace {

constexpr std::array<const char*, num_medium_fields> field_names = {grid_names::sigma_a_scale, grid_names::sigma_s_rayleigh,
                                                                    grid_names::sigma_s_mie};

/// Where the opal is (object mm), with the narrow band around it.
openvdb::BBoxd bounds_mm(const openvdb::FloatGrid& shape) {
    const openvdb::CoordBBox voxels = shape.evalActiveVoxelBoundingBox();
    return {shape.indexToWorld(voxels.min()), shape.indexToWorld(voxels.max())};
}

/// Coefficients per unit of each field, per object mm, averaged over the visible spectrum.
std::array<double, num_medium_fields> mean_per_mm(const OpalConstants& constants, double scale) {
    std::array<double, num_medium_fields> sum = {};
    int count = 0;
    for (double wavelength_nm = 400.0; wavelength_nm <= 700.0; wavelength_nm += 10.0, ++count) {
        sum[0] += constants.sigma_a_per_mm.at(wavelength_nm);
        sum[1] += std::pow(400.0 / wavelength_nm, 4);
        sum[2] += constants.sigma_s_mie_shape.value.empty() ? 1.0 : constants.sigma_s_mie_shape.at(wavelength_nm);
    }
    for (double& value : sum) value *= scale / count;
    return sum;
}

}  // namespace

MediumFields::MediumFields(const OpalAsset& asset, MajorantKind majorants, double scale, const std::string& file,
                           TrackingKind tracking)
    : constants_{1.0, asset.constants.sigma_s_rayleigh_400nm_per_mm, asset.constants.sigma_s_mie_per_mm} {
    const std::array<openvdb::FloatGrid::Ptr, num_medium_fields> given = {asset.sigma_a_scale, asset.sigma_s_rayleigh_400nm,
                                                                          asset.sigma_s_mie};
    for (std::size_t f = 0; f < given.size(); ++f) {
        if (!given[f]) continue;
        const openvdb::FloatGrid::Ptr fitted = fit_field(*given[f], *asset.shape);
        const FieldSummary summary = summarize_field(*fitted, nullptr);
        if (summary.min == summary.max) {
            constants_[f] = double(summary.max);
            continue;
        }
        constants_[f] = 1.0;
        grids_[f] = fitted;
        views_[f] = data_.emplace_back(*fitted).view();
    }
    if (data_.empty()) return;
    const openvdb::BBoxd bounds = bounds_mm(*asset.shape);
    majorants_ = std::make_unique<MajorantGrid>(
        MajorantGrid::chosen(grids_, bounds, majorants, tracking, mean_per_mm(asset.constants, scale)));
    check_majorants(grids_, majorants_->view(), field_names, file);
}

void MediumFields::attach(MediumView& view) const {
    if (!majorants_) return;
    std::copy(views_.begin(), views_.end(), view.fields);
    view.majorants = majorants_->view();
}

}  // namespace opal
