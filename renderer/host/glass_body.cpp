// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/glass_body.h"

#include <algorithm>

#include "formats/spectrum.h"
#include "formats/units.h"
#include "renderer/host/mesh_data.h"

namespace opal {
namespace {

/// Mean of a 1 nm table over the light that counts, for the size of the majorants' cells.
double visible_mean(const std::vector<float>& table) {
    double sum = 0.0;
    for (int wavelength_nm = 400; wavelength_nm < 700; ++wavelength_nm)
        sum += double(table[std::size_t(wavelength_nm - int(units::wavelength_min_nm))]);
    return sum / 300.0;
}

}  // namespace

GlassBody::GlassBody(const ObjectDescription& object, const MaterialDescription& material, const OpalDescription& settings,
                     const openvdb::BBoxd& bounds_mm)
    : no_contrast_(spectrum_samples, 0.0f), equal_index_(spectrum_samples, 1.0f) {
    const MediumDescription& medium = material.medium;
    // The density counts through the coefficients: one look into the grid gives both.
    const double factor = medium.density_scale;
    const SampledSpectrum absorption =
        absorber_spectrum(medium.absorber, medium.sigma_a_per_mm * factor, medium.sigma_a_reference_nm);
    for (int i = 0; i < spectrum_samples; ++i) {
        const double wavelength_nm = units::wavelength_min_nm + i;
        index_.push_back(float(material.n.at(settings.dispersion == Dispersion::full ? wavelength_nm : sodium_d_nm)));
        sigma_a_per_mm_.push_back(float(absorption.at(wavelength_nm)));
        sigma_s_per_mm_.push_back(float(medium.sigma_s_per_mm * factor));
    }
    view_.diffraction = Diffraction::none;
    view_.world_from_object = object_transform(object);
    view_.n_eff = view_.surface_index = index_.data();
    view_.contrast = no_contrast_.data();
    view_.relative_index = equal_index_.data();
    view_.surface_disperses = std::any_of(index_.begin(), index_.end(), [&](float n) { return n != index_.front(); });
    view_.roughness = float(material.roughness);
    view_.medium.sigma_a_per_mm = sigma_a_per_mm_.data();
    view_.medium.sigma_s_mie_per_mm = sigma_s_per_mm_.data();
    view_.medium.mie_phase.kind = PhaseKind::henyey_greenstein;
    view_.medium.mie_phase.g = float(medium.asymmetry);
    if (medium.density_file.empty()) return;
    const double scale = object.scale;
    density_ = std::make_unique<DensityField>(
        medium, bounds_mm, settings.majorants, settings.tracking,
        std::array<double, num_medium_fields>{scale * visible_mean(sigma_a_per_mm_), 0.0, scale * visible_mean(sigma_s_per_mm_)});
    density_->attach(view_.medium);
}

}  // namespace opal
