// SPDX-License-Identifier: Apache-2.0
#include "formats/crystal_defect.h"

#include <cmath>

#include "formats/opal_asset.h"
#include "formats/units.h"

namespace opal {

double CrystalDefect::effective_index(double wavelength_nm) const {
    static const double filling = units::pi / (3.0 * std::sqrt(2.0));
    // In this form equal indices give exactly that index.
    const double medium = n_medium.at(wavelength_nm);
    return medium + filling * (n_sphere.at(wavelength_nm) - medium);
}

double CrystalDefect::relative_index(double wavelength_nm) const {
    const RefractiveIndex& inside = particle == MieParticle::vacancy ? n_medium : n_sphere;
    return inside.at(wavelength_nm) / effective_index(wavelength_nm);
}

double CrystalDefect::size_parameter(double wavelength_nm) const {
    return units::pi * diameter_nm * effective_index(wavelength_nm) / wavelength_nm;
}

double CrystalDefect::cross_section_nm2(double wavelength_nm) const {
    const double index = relative_index(wavelength_nm);
    if (index == 1.0) return 0.0;
    const MieCoefficients coefficients = mie_coefficients(size_parameter(wavelength_nm), index);
    return mie_efficiencies(coefficients).q_sca * units::pi * diameter_nm * diameter_nm / 4.0;
}

CrystalDefect crystal_defect(const OpalConstants& constants) {
    return {constants.n_sphere, constants.n_medium, constants.mie_particle,
            constants.mie_particle_diameter_nm > 0.0 ? constants.mie_particle_diameter_nm : constants.sphere_diameter_nm};
}

}  // namespace opal
