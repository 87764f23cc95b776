// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/opal_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/error.h"
#include "formats/opal_asset.h"
#include "formats/units.h"
#include "renderer/core/mosaic.h"
#include "renderer/host/opal_surface.h"
#include "renderer/host/patch_surface.h"
#include "renderer/host/stacking.h"

namespace opal {
namespace {

/// The families that planes of the crystal offer: all inside the limiting sphere, or the strongest where there are more than a
/// stay in a grain can mark.
int choose_pairs(const OpalConstants& constants, PlanePair* chosen, int& reciprocal_points, std::vector<std::string>& notices) {
    const CrystalParameters crystal{constants.sphere_diameter_nm, constants.n_sphere.at(units::wavelength_min_nm),
                                    constants.n_medium.at(units::wavelength_min_nm)};
    std::vector<PlanePair> pairs = stacked_pairs(crystal, constants.stacking_fault_probability, units::wavelength_min_nm);
    reciprocal_points = 2 * int(pairs.size()) + 1;
    const std::size_t inside = pairs.size();
    std::erase_if(pairs, [](const PlanePair& pair) { return !(pair.form > 0.0f); });
    if (pairs.size() > max_tested_pairs) {
        std::stable_sort(pairs.begin(), pairs.end(), [](const PlanePair& a, const PlanePair& b) { return a.form > b.form; });
        pairs.resize(max_tested_pairs);
        notices.push_back(
            fmt::format("{} families of planes can diffract visible light; the {} strongest are used (next: {:.2g} of the first)",
                        inside, max_tested_pairs, double(pairs.back().form) / double(pairs.front().form)));
    }
    std::copy(pairs.begin(), pairs.end(), chosen);
    return static_cast<int>(pairs.size());
}

OpticalTables optical_tables(const OpalConstants& constants, Dispersion dispersion) {
    OpticalTables tables;
    const auto n_eff = [](double n_sphere, double n_medium) {
        return float(fcc_filling * n_sphere + (1.0 - fcc_filling) * n_medium);
    };
    const float mean = n_eff(constants.n_sphere.at(sodium_d_nm), constants.n_medium.at(sodium_d_nm));
    for (int i = 0; i < spectrum_samples; ++i) {
        const double wavelength_nm = dispersion == Dispersion::none ? sodium_d_nm : units::wavelength_min_nm + i;
        const double n_sphere = constants.n_sphere.at(wavelength_nm), n_medium = constants.n_medium.at(wavelength_nm);
        tables.n_eff.push_back(n_eff(n_sphere, n_medium));
        tables.contrast.push_back(float(std::abs(n_sphere * n_sphere - n_medium * n_medium)));
        tables.relative_index.push_back(float(n_sphere / n_medium));
        tables.surface_index.push_back(dispersion == Dispersion::full ? tables.n_eff.back() : mean);
        tables.surface_disperses = tables.surface_disperses || tables.surface_index.back() != tables.surface_index.front();
    }
    return tables;
}

Diffraction transport_model(DiffractionModel model) {
    switch (model) {
        case DiffractionModel::ewald_fresnel:
            return Diffraction::ewald_fresnel;
        case DiffractionModel::laue:
            return Diffraction::laue;
        case DiffractionModel::none:
            return Diffraction::none;
        case DiffractionModel::two_beam:
            break;
    }
    return Diffraction::two_beam;
}

}  // namespace

OpalBody::OpalBody(const ObjectDescription& object, const OpalDescription& settings, std::vector<std::string>& notices) {
    ReadOpalOptions options;
    options.orientation_seed = object.orientation_seed;
    std::vector<std::string> file_notices;
    const OpalAsset asset = read_opal_asset(object.file, options, file_notices);
    const std::string file = object.file.string();
    for (const std::string& notice : file_notices) notices.push_back(file + ": " + notice);
    if (!asset.shape)
        throw InputError(file + ": holds sites alone, no shape; build it with [output] grids = [\"shape\", \"sites\"]");

    OpalView& opal = view_;
    opal.diffraction = transport_model(settings.diffraction);
    opal.ewald_tolerance = float(settings.ewald_tolerance);
    if (opal.diffraction == Diffraction::ewald_fresnel)
        notices.push_back(
            fmt::format("{}: what \"ewald-fresnel\" reflects is in proportion to opal.ewald_tolerance = {:.3g}, which "
                        "nothing fixes: for comparison alone",
                        file, settings.ewald_tolerance));
    opal.max_odds = float(settings.max_odds);
    if (object.exact && asset.bezier_patches.empty())
        throw InputError(file + ": has no Bezier patches, which exact = true asks for; shapes of kind \"bezier\" have them");
    if (object.exact)
        patches_ = asset.bezier_patches;
    else
        surface_ = surface_from_level_set(*asset.shape, file);

    grains_ = std::make_unique<GrainSource>(asset, settings.grains, file, notices);
    opal.grains = grains_->view();
    opal.grain_size_mm = grains_->sizes_mm().data();
    shape_ = std::make_unique<FieldGridData>(*asset.shape);
    opal.shape = shape_->view();
    for (const auto& q : asset.grain_orientations) orientations_.push_back({q[0], q[1], q[2], q[3]});
    opal.orientations = orientations_.data();
    opal.num_grains = int(orientations_.size());

    recipe_toml_ = asset.recipe_toml;
    const OpalConstants& constants = asset.constants;
    optics_ = optical_tables(constants, settings.dispersion);
    opal.n_eff = optics_.n_eff.data();
    opal.contrast = optics_.contrast.data();
    opal.relative_index = optics_.relative_index.data();
    opal.surface_index = optics_.surface_index.data();
    opal.surface_disperses = optics_.surface_disperses;
    opal.roughness = float(object.roughness);
    opal.num_pairs = choose_pairs(constants, opal.pairs, reciprocal_points_, notices);
    // Places beyond the last repeat it without its strength.
    for (int k = 0; k < max_tested_pairs && opal.num_pairs > 0; ++k)
        opal.families.set(k, opal.pairs[std::min(k, opal.num_pairs - 1)]);
    for (int k = opal.num_pairs; k < max_tested_pairs; ++k) opal.families.form[k] = 0.0f;
    opal.coherence_nm = float(constants.coherence_length_um * units::nm_per_um);
    opal.fault = float(constants.stacking_fault_probability);
    opal.layer_nm = float(stacked_layer_nm(constants.sphere_diameter_nm));
    if (constants.mosaic_spread_deg > 0.0)
        opal.mosaic_kappa = mosaic_exponent(float(units::rad_from_deg(constants.mosaic_spread_deg)));

    medium_fields_ =
        std::make_unique<MediumFields>(asset, settings.majorants, double(float(object.scale)), file, settings.tracking);
    medium_fields_->attach(opal.medium);
    const double sigma_a_scale = medium_fields_->constant(MediumField::sigma_a_scale);
    const double sigma_s_mie_per_mm = medium_fields_->constant(MediumField::sigma_s_mie);
    for (int i = 0; i < spectrum_samples; ++i) {
        const double wavelength_nm = units::wavelength_min_nm + i;
        sigma_a_per_mm_.push_back(float(sigma_a_scale * constants.sigma_a_per_mm.at(wavelength_nm)));
        const SampledSpectrum& shape = constants.sigma_s_mie_shape;
        sigma_s_mie_per_mm_.push_back(float(sigma_s_mie_per_mm * (shape.value.empty() ? 1.0 : shape.at(wavelength_nm))));
    }
    opal.medium.sigma_a_per_mm = sigma_a_per_mm_.data();
    opal.medium.sigma_s_rayleigh_400nm_per_mm = float(medium_fields_->constant(MediumField::sigma_s_rayleigh_400nm));
    opal.medium.sigma_s_mie_per_mm = sigma_s_mie_per_mm_.data();
    if (sigma_s_mie_per_mm > 0.0) mie_phase_ = make_phase_function(constants);
    opal.medium.mie_phase = mie_phase_.view();
}

std::vector<MeshData> OpalBody::surfaces(const RigidTransform& world_from_object) const {
    if (!patches_.empty()) return surfaces_from_patches(patches_, world_from_object);
    std::vector<MeshData> meshes = {surface_};
    transform_mesh(meshes.back(), world_from_object);
    return meshes;
}

}  // namespace opal
