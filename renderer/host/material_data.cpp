// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/material_data.h"

#include <algorithm>

#include "formats/illuminant.h"
#include "formats/metals.h"
#include "formats/units.h"
#include "renderer/host/upsampler.h"

namespace opal {
namespace {

/// Linear sRGB of a metal's reflectance at normal incidence.
Rgb daylight_color(const MetalIndex& metal) {
    SampledSpectrum reflectance;
    for (int i = 0; i < spectrum_samples; ++i) {
        reflectance.wavelength_nm.push_back(units::wavelength_min_nm + i);
        reflectance.value.push_back(normal_reflectance(metal.at(units::wavelength_min_nm + i)));
    }
    const Rgb3d color = linear_srgb_from_xyz(xyz_of(reflectance, illuminant_spectrum(IlluminantKind::d65)));
    const auto in_gamut = [](double component) { return float(std::clamp(component, 0.0, 1.0)); };
    return {in_gamut(color.r), in_gamut(color.g), in_gamut(color.b)};
}

}  // namespace

MaterialData::MaterialData(const MaterialDescription& material, UpsamplingMethod upsampling, Dispersion dispersion)
    : roughness_(float(material.roughness)) {
    if (material.kind == MaterialKind::diffuse || material.kind == MaterialKind::plastic)
        albedo_ =
            upsample_reflectance(upsampling, {float(material.albedo[0]), float(material.albedo[1]), float(material.albedo[2])});
    if (material.kind == MaterialKind::conductor) {
        model_ = MaterialModel::conductor;
        const MetalIndex metal = MetalIndex::from_name(material.metal);
        for (int i = 0; i < spectrum_samples; ++i) {
            const ComplexIndex index = metal.at(units::wavelength_min_nm + i);
            index_.push_back(float(index.n));
            extinction_.push_back(float(index.k));
        }
        albedo_ = upsample_reflectance(upsampling, daylight_color(metal));
    }
    if (material.kind == MaterialKind::plastic) {
        model_ = MaterialModel::plastic;
        for (int i = 0; i < spectrum_samples; ++i)
            index_.push_back(float(material.n.at(dispersion == Dispersion::full ? units::wavelength_min_nm + i : sodium_d_nm)));
    }
}

void MaterialData::prepare_coat(std::span<const OpalView> bodies) {
    if (model_ != MaterialModel::plastic || roughness_ < min_roughness) return;
    // Just as the transport divides them.
    const auto range_against = [&](const float* index_before) {
        EtaRange range{1.0e9f, 0.0f};
        for (int i = 0; i < spectrum_samples; ++i) {
            const float eta = index_[std::size_t(i)] / (index_before ? index_before[i] : 1.0f);
            range = {std::min(range.least, eta), std::max(range.most, eta)};
        }
        return range;
    };
    std::vector<EtaRange> ranges = {range_against(nullptr)};
    for (const OpalView& body : bodies) ranges.push_back(range_against(body.surface_index));
    coat_ = make_coat_albedo(roughness_, ranges);
}

MaterialView MaterialData::view() const {
    MaterialView view;
    view.model = model_;
    view.albedo = albedo_;
    view.roughness = roughness_;
    view.index = index_.data();
    view.extinction = extinction_.data();
    view.coat_albedo = coat_.view();
    return view;
}

}  // namespace opal
