// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/diffraction_models.h"
#include "renderer/optics/crystal_optics.h"

namespace opal {

enum class ReflectanceModel { two_beam, ewald_fresnel, laue, transfer_matrix };

/// What a slab lies in.
enum class Ambient {
    mean_index,  ///< a medium of its own mean index: nothing is reflected by its faces as such
    medium,      ///< transfer-matrix: what is between the spheres, which are whole at both faces
};

/// A slab of a perfect crystal, or a pile of such slabs, with planes (hkl) parallel to its faces.
struct ReflectanceSetup {
    CrystalOptics crystal;
    PlaneFamily planes;
    double layers = 24.0;           ///< thickness of a slab times |G|
    double blocks = 1.0;            ///< slabs in an incoherent pile
    double ewald_tolerance = 0.01;  ///< ewald-fresnel
    int slices_per_period = 1024;   ///< transfer-matrix: films per distance of two planes of centres
    ReflectanceModel model = ReflectanceModel::two_beam;
    Ambient ambient = Ambient::mean_index;
};

/// Index of the medium that the directions inside refer to: the crystal's effective index; for the transfer matrix, which knows
/// no effective index, that of its ambient, the root of the mean permittivity or the medium's.
double direction_index(const ReflectanceSetup& setup, double wavelength_nm);

/// Reflectance at a vacuum wavelength for light that travels at `cosine` to the planes' normal inside the crystal.
///  - two-beam: kappa = pi |eps_G| C / (n_eff lambda c), C = 1 (s) or |1 - 2 c^2| (p); delta = pi |G| (lambda_B / lambda - 1);
///    nothing more than an octave from lambda_B, where the picture of one strong reciprocal vector does not hold.
///  - laue: the same coupling without the weakening of the beam, at most 1.
///  - ewald-fresnel: independent of the thickness.
///  - transfer-matrix: Maxwell's equations for the permittivity averaged over the planes, without approximation.
PolarizedReflectance<double> reflectance_at(const ReflectanceSetup& setup, double wavelength_nm, double cosine);

}  // namespace opal
