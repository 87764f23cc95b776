// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/lorenz_mie.h"
#include "formats/recipe.h"
#include "formats/refractive_index.h"

namespace opal {

struct OpalConstants;

/// A ball that scatters because it breaks the crystal's order, in a medium of the crystal's effective index: a missing sphere,
/// filled with what is between the spheres, or a sphere too many.
struct CrystalDefect {
    RefractiveIndex n_sphere = 1.45;
    RefractiveIndex n_medium = 1.333;
    MieParticle particle = MieParticle::vacancy;
    double diameter_nm = 250.0;

    /// n_medium + f (n_sphere - n_medium) with the filling f = pi / (3 sqrt 2) of touching spheres.
    double effective_index(double wavelength_nm) const;
    /// Index of the ball over that of the crystal.
    double relative_index(double wavelength_nm) const;
    /// pi diameter n / (vacuum wavelength).
    double size_parameter(double wavelength_nm) const;
    /// Scattering cross-section by the Lorenz-Mie series; 0 where the ball has the crystal's index.
    double cross_section_nm2(double wavelength_nm) const;
};

/// The defect that the constants name: their particle, as large as the crystal's spheres where no diameter is given.
CrystalDefect crystal_defect(const OpalConstants& constants);

}  // namespace opal
