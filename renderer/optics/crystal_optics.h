// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/refractive_index.h"
#include "renderer/core/crystal.h"

namespace opal {

/// Wavelengths at which refractive indices that vary are asked for: the built-in formulas have their resonances outside.
inline constexpr double index_from_nm = 200.0, index_to_nm = 2500.0;

/// How the effective index follows from the two indices and the filling f.
enum class IndexMean {
    linear,           ///< f n_sphere + (1 - f) n_medium
    maxwell_garnett,  ///< spheres in a host: Maxwell Garnett, Phil. Trans. R. Soc. A 203, 1904
    permittivity,     ///< root of the volume mean of n^2
};

/// A perfect fcc crystal of spheres in a medium. Filled less than touching spheres fill space, it is the same crystal with the
/// spheres further apart.
struct CrystalOptics {
    double sphere_diameter_nm = 250.0;
    RefractiveIndex n_sphere = 1.45;
    RefractiveIndex n_medium = 1.333;
    double filling = fcc_filling;  ///< part of the volume inside spheres, at most that of touching ones
    IndexMean index_mean = IndexMean::linear;

    /// Edge of the cubic cell, which holds four spheres: a = d (2 pi / (3 f))^(1/3), sqrt 2 d where they touch.
    double cell_edge_nm() const;
    double mean_permittivity(double wavelength_nm) const;
    double effective_index(double wavelength_nm) const;
};

/// The lattice planes (hkl) of a crystal, parallel to the surface of a sample.
struct PlaneFamily {
    int h = 1, k = 1, l = 1;

    /// |G| = sqrt(h^2 + k^2 + l^2) / a, without the factor 2 pi; its inverse is the distance between two planes.
    double g_per_nm(const CrystalOptics& crystal) const;
    /// The multiple that G is of the shortest reciprocal vector in its direction: 2 for (222), 1 for (200), since fcc has no
    /// (100).
    int order() const;
    /// Whether fcc has this reciprocal vector: all even or all odd, and not the origin.
    bool allowed() const;
};

/// Fourier coefficient of the permittivity: (n_s^2 - n_m^2) f 3 (sin x - x cos x) / x^3, x = pi |G| d (form factor of a sphere).
double permittivity_coefficient(const CrystalOptics& crystal, const PlaneFamily& planes, double wavelength_nm);

/// Bragg wavelength (vacuum nm) of planes met at `angle_outside_rad` in air: lambda = 2 sqrt(n_eff^2 - sin^2) / |G|, the law of
/// Bragg with the refraction of a surface parallel to the planes, solved together with n_eff(lambda). Indices that vary are taken
/// between index_from_nm and index_to_nm. Throws InputError where the two do not settle, which takes an index that varies wildly.
double bragg_wavelength_outside_nm(const CrystalOptics& crystal, const PlaneFamily& planes, double angle_outside_rad);

/// Relative width of the stop band, s polarization: |eps_G| / (mean permittivity c^2), c the cosine to the planes' normal inside
/// the crystal. The band of p is narrower by |1 - 2 c^2|.
double relative_band_width(const CrystalOptics& crystal, const PlaneFamily& planes, double wavelength_nm, double cosine);

}  // namespace opal
