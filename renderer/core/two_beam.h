// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/spectrum_view.h"

/// Two-beam dynamical diffraction by one family of lattice planes.
namespace opal {

/// sin^2(x) for any |x| up to some thousands: reduction to a quarter period, then a polynomial; absolute error below 1e-6 plus
/// the rounding of x itself. Free of branches so that the lanes vectorize.
OPAL_HD inline float sine_squared(float x) {
    const float turns = x * (1.0f / pi_f);
    const float y = pi_f * (turns - rintf(turns));
    const float y2 = y * y;
    const float s =
        y * (1.0f + y2 * (-1.0f / 6.0f +
                          y2 * (1.0f / 120.0f + y2 * (-1.0f / 5040.0f + y2 * (1.0f / 362880.0f + y2 * (-1.0f / 39916800.0f))))));
    return s * s;
}

/// sinh^2(x) / x^2 for x^2 = `x2` >= 0, capped where the reflectance is 1 to single precision anyway.
OPAL_HD inline float sinh_squared_over_square(float x2) {
    const float x = min_of(sqrtf(x2), 12.0f);
    if (x < 0.05f) return 1.0f + x2 * (1.0f / 3.0f) + x2 * x2 * (2.0f / 45.0f);
    const float s = sinhf(x);
    return s * s / (x * x);
}

/// Below this (gamma t)^2 outside the band, sin^2(x) / x^2 is taken from its series: no division by a rounded-off zero.
inline constexpr float band_edge_x2 = 1.0e-3f;

/// Odds of reflection r / (1 - r) of one coherent block:
///   r / (1 - r) = (kappa t)^2 sinh^2(gamma t) / (gamma t)^2,  (gamma t)^2 = (kappa t)^2 - (delta t)^2,
/// which is the two-beam reflectance kappa^2 sinh^2 / (gamma^2 cosh^2 + delta^2 sinh^2) written without overflow; beyond the band
/// edge sinh becomes sin. `kappa_t` and `delta_t` are dimensionless: coupling and detuning times the block's thickness.
OPAL_HD inline float block_reflection_odds(float kappa_t, float delta_t) {
    const float kappa2 = kappa_t * kappa_t;
    const float x2 = delta_t * delta_t - kappa2;
    if (x2 <= 0.0f) return kappa2 * sinh_squared_over_square(-x2);
    if (x2 < band_edge_x2) return kappa2 * (1.0f - x2 * (1.0f / 3.0f));
    return kappa2 * sine_squared(sqrtf(x2)) / x2;
}

/// Optical constants of the crystal at the lanes of a path.
template <int N>
struct LaneOptics {
    float wavelength_nm[N];
    float n_eff[N];
    float contrast[N];        ///< |n_sphere^2 - n_medium^2|
    float relative_index[N];  ///< n_sphere / n_medium
    float surface_index[N];   ///< at the opal's surface
};

/// One family of planes met at a given angle by light of one polarization: everything but the wavelength.
struct BeamGeometry {
    float cosine;        ///< |w . g|, direction of travel against the planes' normal
    float g_per_nm;      ///< |G|
    float form;          ///< |eps_G| over the contrast of permittivity
    float block_nm;      ///< thickness of one coherent block along the normal
    bool p_polarized;    ///< in the plane of incidence
    float share = 1.0f;  ///< part of the path that lies in blocks which hold this family
};

/// Rate (1/mm) at which light on its way through a pile of incoherently stacked blocks is turned by a family of planes, for every
/// lane. A path of length l crosses M = l c / t blocks; walking back and forth between the two beams with the rate M r / (1 - r)
/// / l gives the pile's reflectance M r / (1 + (M - 1) r) exactly. Coupling kappa = pi |eps_G| C / (n lambda c), C = 1 (s) or |1
/// - 2 c^2| (p); detuning delta = 2 pi (n c / lambda - |G| / 2) = pi |G| (lambda_B / lambda - 1) (two-beam dynamical diffraction,
/// Zachariasen 1945). More than an octave from the Bragg wavelength the two-beam picture (one strong G near its Bragg condition)
/// does not hold, and grazing passes would get a coupling that grows without bound: nothing is reflected there. Rates saturate
/// towards `max_rate_per_mm`, harmonically, so that light inside a band is not turned without end. Returns false where all are 0.
/// The loops are free of branches and calls so that they vectorize; the few elements inside the band are mended afterwards.
template <int N>
OPAL_HD inline bool reflection_rates(const BeamGeometry& beam, const LaneOptics<N>& optics, float max_rate_per_mm,
                                     float* rate_per_mm) {
    const float bragg_over_n_nm = 2.0f * beam.cosine / beam.g_per_nm;
    float ratio[N];
    bool any_near = false;
    for (int i = 0; i < N; ++i) {
        ratio[i] = bragg_over_n_nm * optics.n_eff[i] / optics.wavelength_nm[i];
        any_near = any_near || (ratio[i] >= 0.5f && ratio[i] <= 2.0f);
    }
    if (!any_near) return false;

    const float factor = beam.p_polarized ? fabsf(1.0f - 2.0f * beam.cosine * beam.cosine) : 1.0f;
    const float coupling = pi_f * beam.form * factor * beam.block_nm / beam.cosine;
    const float detuning = pi_f * beam.g_per_nm * beam.block_nm;
    const float blocks_per_mm = beam.share * beam.cosine * 1.0e6f / beam.block_nm;
    float kappa_t[N], delta_t[N], x2[N];
    OPAL_SIMD
    for (int i = 0; i < N; ++i) {
        const float near = ratio[i] >= 0.5f && ratio[i] <= 2.0f ? coupling : 0.0f;
        kappa_t[i] = near * optics.contrast[i] / (optics.n_eff[i] * optics.wavelength_nm[i]);
        delta_t[i] = detuning * (ratio[i] - 1.0f);
    }
    OPAL_SIMD
    for (int i = 0; i < N; ++i) {
        const float kappa2 = kappa_t[i] * kappa_t[i];
        x2[i] = delta_t[i] * delta_t[i] - kappa2;
        const float outside = x2[i] < band_edge_x2 ? band_edge_x2 : x2[i];
        rate_per_mm[i] = blocks_per_mm * kappa2 * sine_squared(sqrtf(outside)) / outside;
    }
    float smallest = x2[0];
    for (int i = 1; i < N; ++i) smallest = min_of(smallest, x2[i]);
    if (smallest < band_edge_x2)
        for (int i = 0; i < N; ++i)
            if (x2[i] < band_edge_x2) rate_per_mm[i] = blocks_per_mm * block_reflection_odds(kappa_t[i], delta_t[i]);
    OPAL_SIMD
    for (int i = 0; i < N; ++i) rate_per_mm[i] *= max_rate_per_mm / (max_rate_per_mm + rate_per_mm[i]);
    return true;
}

}  // namespace opal
