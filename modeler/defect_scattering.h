// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "formats/recipe.h"
#include "formats/spectrum.h"

namespace opal {

/// What a crystal's defects scatter, each by itself.
struct DefectScattering {
    double sigma_s_550nm_per_mm = 0.0;
    SampledSpectrum shape;  ///< every 5 nm from 360 to 830 nm, 1 at 550 nm; empty where nothing scatters
};

/// Number density times Lorenz-Mie cross-section of the recipe's particle, base_color.defect_concentration of them per site of an
/// fcc lattice of touching spheres, of which there are 4 / (sqrt(2) d)^3. Independent scattering: neighbours of a defect, and
/// correlations between defects, are not in it. Throws InputError where the particle is too large for the series.
DefectScattering defect_scattering(const CrystalRecipe& crystal, const BaseColorRecipe& color);

}  // namespace opal
