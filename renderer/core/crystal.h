// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/vec.h"

/// The colloidal crystal: touching spheres on an fcc lattice, and its reciprocal vectors inside the limiting sphere.
namespace opal {

inline constexpr double fcc_filling = 0.74048048969306104;  ///< pi / (3 sqrt 2)

/// A pair of reciprocal vectors +G and -G: one family of lattice planes. No factor 2 pi: |G| = sqrt(h^2+k^2+l^2) / a.
struct PlanePair {
    Vec3 normal;                  ///< unit G, lattice frame (cubic axes)
    real g_per_nm;                ///< |G|
    real form;                    ///< |Fourier coefficient of the permittivity| over the contrast n_sphere^2 - n_medium^2
    int h, k, l;                  ///< of stacked crystals: hexagonal H, K and the order along the stacking axis
    real coherence_nm = 3.0e38f;  ///< mean thickness of a block of this family where faults limit it
    int twin = 0;                 ///< of stacked crystals: 1 a family of the lattice's own stacking, -1 of its twin's; 0 of both
};

/// Enough for spheres of 1000 nm and indices of 4: |G| <= 2 n / 360 nm.
inline constexpr int max_plane_pairs = 16384;
/// Pairs that one grain crossing may test: a bit each in the path's "already tested" mask.
inline constexpr int max_tested_pairs = 64;

static_assert(max_tested_pairs % 8 == 0, "families are read in blocks");

/// The same families side by side, as vector units read them; `form` is 0 beyond the last.
struct PlaneFamilies {
    real normal_x[max_tested_pairs] = {}, normal_y[max_tested_pairs] = {}, normal_z[max_tested_pairs] = {};
    real g_per_nm[max_tested_pairs] = {};
    real form[max_tested_pairs] = {};
    real coherence_nm[max_tested_pairs] = {};
    real twin[max_tested_pairs] = {};

    void set(int k, const PlanePair& pair) {
        normal_x[k] = pair.normal.x;
        normal_y[k] = pair.normal.y;
        normal_z[k] = pair.normal.z;
        g_per_nm[k] = pair.g_per_nm;
        form[k] = pair.form;
        coherence_nm[k] = pair.coherence_nm;
        twin[k] = real(pair.twin);
    }
};

struct CrystalParameters {
    double sphere_diameter_nm = 250.0;
    double n_sphere = 1.45;
    double n_medium = 1.333;
};

/// Effective index of the opal, n = f n_sphere + (1 - f) n_medium (the source's linear mean).
inline double effective_index(const CrystalParameters& crystal) {
    return fcc_filling * crystal.n_sphere + (1.0 - fcc_filling) * crystal.n_medium;
}

/// Form factor of a fraction f of spheres at |G| (1/nm): f 3 (sin x - x cos x) / x^3 with x = pi |G| d.
inline double sphere_form_factor(double sphere_diameter_nm, double g_per_nm) {
    const double x = 3.14159265358979324 * g_per_nm * sphere_diameter_nm;
    return fcc_filling * 3.0 * (sin(x) - x * cos(x)) / (x * x * x);
}

/// Fourier coefficient of the permittivity of touching spheres: (n_s^2 - n_m^2) times the form factor.
inline double permittivity_coefficient(const CrystalParameters& crystal, double g_per_nm) {
    const double contrast = crystal.n_sphere * crystal.n_sphere - crystal.n_medium * crystal.n_medium;
    return contrast * sphere_form_factor(crystal.sphere_diameter_nm, g_per_nm);
}

/// All pairs with |G| <= 2 n_eff / lambda_min, shortest first (then by h, k, l), the first `capacity` of them. Returns how many
/// lie inside; the limiting sphere then holds 2 * result + 1 points with the origin. fcc: h, k, l all even or all odd.
inline int reciprocal_pairs(const CrystalParameters& crystal, double wavelength_min_nm, PlanePair* pairs, int capacity) {
    const double edge_nm = 1.4142135623730951 * crystal.sphere_diameter_nm;
    const double g_max_per_nm = 2.0 * effective_index(crystal) / wavelength_min_nm;
    const int limit = int(g_max_per_nm * edge_nm) + 1;
    const int square_limit = int(g_max_per_nm * edge_nm * g_max_per_nm * edge_nm);
    int count = 0;
    for (int norm = 1; norm <= square_limit; ++norm)
        for (int h = 0; h <= limit; ++h)
            for (int k = -limit; k <= limit; ++k) {
                const int rest = norm - h * h - k * k;
                const int magnitude = rest < 0 ? -1 : int(sqrt(double(rest)) + 0.5);
                if (magnitude < 0 || magnitude * magnitude != rest) continue;
                for (int l = -magnitude; l <= magnitude; l += max_of(1, 2 * magnitude)) {
                    const bool allowed = ((h ^ k) & 1) == 0 && ((k ^ l) & 1) == 0;
                    const bool first_of_pair = h > 0 || (h == 0 && (k > 0 || (k == 0 && l > 0)));
                    if (!allowed || !first_of_pair) continue;
                    const double root = sqrt(double(norm));
                    const double g_per_nm = root / edge_nm;
                    if (count < capacity)
                        pairs[count] = {{real(h / root), real(k / root), real(l / root)},
                                        real(g_per_nm),
                                        real(fabs(sphere_form_factor(crystal.sphere_diameter_nm, g_per_nm))),
                                        h,
                                        k,
                                        l};
                    ++count;
                }
            }
    return count;
}

}  // namespace opal
