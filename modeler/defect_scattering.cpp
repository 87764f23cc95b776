// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/defect_scattering.h"

#include <cmath>

#include "formats/crystal_defect.h"
#include "formats/units.h"

namespace opal {
namespace {

constexpr double reference_nm = 550.0;
constexpr int step_nm = 5;

}  // namespace

DefectScattering defect_scattering(const CrystalRecipe& crystal, const BaseColorRecipe& color) {
    const CrystalDefect defect{
        crystal.n_sphere, crystal.n_medium, color.mie_particle,
        color.mie_particle_diameter_nm > 0.0 ? color.mie_particle_diameter_nm : crystal.sphere_diameter_nm};
    const double sites_per_nm3 = 4.0 / std::pow(std::sqrt(2.0) * crystal.sphere_diameter_nm, 3);
    const double reference_nm2 = defect.cross_section_nm2(reference_nm);
    DefectScattering result;
    result.sigma_s_550nm_per_mm = color.defect_concentration * sites_per_nm3 * reference_nm2 * units::nm_per_mm;
    if (!(result.sigma_s_550nm_per_mm > 0.0)) return result;
    for (int wavelength_nm = int(units::wavelength_min_nm); wavelength_nm <= int(units::wavelength_max_nm);
         wavelength_nm += step_nm) {
        result.shape.wavelength_nm.push_back(wavelength_nm);
        result.shape.value.push_back(defect.cross_section_nm2(wavelength_nm) / reference_nm2);
    }
    return result;
}

}  // namespace opal
