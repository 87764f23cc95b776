// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/spectrum_view.h"

/// Two-beam dynamical diffraction by one family of lattice planes.
namespace opal {

/// sin^2(x) for any |x| up to some thousands: reduction to a quarter period, then a polynomial; absolute error below 1e-6 plus
/// the rounding of x itself. Free of branches so that the lanes vectorize. In double precision the library's own.
OPAL_HD inline real sine_squared(real x) {
    if constexpr (sizeof(real) > sizeof(float)) return square(sin(x));
    const real turns = x * (1.0f / pi_f);
    const real y = pi_f * (turns - rint(turns));
    const real y2 = y * y;
    const real s =
        y * (1.0f + y2 * (-1.0f / 6.0f +
                          y2 * (1.0f / 120.0f + y2 * (-1.0f / 5040.0f + y2 * (1.0f / 362880.0f + y2 * (-1.0f / 39916800.0f))))));
    return s * s;
}

/// sinh^2(x) / x^2 for x^2 = `x2` >= 0, capped where the reflectance is 1 to single precision anyway.
OPAL_HD inline real sinh_squared_over_square(real x2) {
    const real x = min_of(sqrt(x2), 12.0f);
    if (x < 0.05f) return 1.0f + x2 * (1.0f / 3.0f) + x2 * x2 * (2.0f / 45.0f);
    const real s = sinh(x);
    return s * s / (x * x);
}

/// Below this (gamma t)^2 outside the band, sin^2(x) / x^2 is taken from its series: no division by a rounded-off zero.
inline constexpr real band_edge_x2 = 1.0e-3f;

/// Odds of reflection r / (1 - r) of one coherent block:
///   r / (1 - r) = (kappa t)^2 sinh^2(gamma t) / (gamma t)^2,  (gamma t)^2 = (kappa t)^2 - (delta t)^2,
/// which is the two-beam reflectance kappa^2 sinh^2 / (gamma^2 cosh^2 + delta^2 sinh^2) written without overflow; beyond the band
/// edge sinh becomes sin. `kappa_t` and `delta_t` are dimensionless: coupling and detuning times the block's thickness.
OPAL_HD inline real block_reflection_odds(real kappa_t, real delta_t) {
    const real kappa2 = kappa_t * kappa_t;
    const real x2 = delta_t * delta_t - kappa2;
    if (x2 <= 0.0f) return kappa2 * sinh_squared_over_square(-x2);
    if (x2 < band_edge_x2) return kappa2 * (1.0f - x2 * (1.0f / 3.0f));
    return kappa2 * sine_squared(sqrt(x2)) / x2;
}

/// Optical constants of the crystal at the lanes of a path.
template <int N>
struct LaneOptics {
    real wavelength_nm[N];
    real n_eff[N];
    real contrast[N];        ///< |n_sphere^2 - n_medium^2|
    real relative_index[N];  ///< n_sphere / n_medium
    real surface_index[N];   ///< at the opal's surface
};

/// How many families of planes are looked at together: as many as a vector register of the host holds; a thread of a device takes
/// them one by one.
#if defined(__CUDA_ARCH__)
inline constexpr int beam_block_size = 1;
#else
inline constexpr int beam_block_size = 8;
#endif

/// Families of planes met at given angles by light of one polarization each: everything but the wavelength.
struct BeamBlock {
    real cosine[beam_block_size];     ///< |w . g|, direction of travel against the planes' normal
    real g_per_nm[beam_block_size];   ///< |G|
    real form[beam_block_size];       ///< |eps_G| over the contrast of permittivity; 0: no family
    real block_nm[beam_block_size];   ///< thickness of one coherent block along the normal
    real polarized[beam_block_size];  ///< 1: p, in the plane of incidence; 0: s
    real share[beam_block_size];      ///< part of the path that lies in blocks which hold this family
};

/// One beam, in every place of a block.
OPAL_HD inline BeamBlock single_beam(real cosine, real g_per_nm, real form, real block_nm, bool p_polarized) {
    BeamBlock beams;
    for (int j = 0; j < beam_block_size; ++j) {
        beams.cosine[j] = cosine;
        beams.g_per_nm[j] = g_per_nm;
        beams.form[j] = form;
        beams.block_nm[j] = block_nm;
        beams.polarized[j] = p_polarized ? 1.0f : 0.0f;
        beams.share[j] = 1.0f;
    }
    return beams;
}

/// C of the coupling: 1 (s) or |1 - 2 c^2| (p).
OPAL_HD inline real polarization_factor(real polarized, real cosine) {
    return 1.0f - polarized + polarized * fabs(1.0f - 2.0f * cosine * cosine);
}

/// Rates (1/mm) at which light on its way through a pile of incoherently stacked blocks is turned by families of planes, per lane
/// and family. A path of length l crosses M = l c / t blocks; walking back and forth between the two beams with the rate M r / (1
/// - r) / l gives the pile's reflectance M r / (1 + (M - 1) r) exactly. Coupling kappa = pi |eps_G| C / (n lambda c), C = 1 (s)
/// or |1 - 2 c^2| (p); detuning delta = 2 pi (n c / lambda - |G| / 2) = pi |G| (lambda_B / lambda - 1) (two-beam dynamical
/// diffraction, Zachariasen 1945). More than an octave from the Bragg wavelength the two-beam picture (one strong G near its
/// Bragg condition) does not hold, and grazing passes would get a coupling that grows without bound: nothing is reflected there.
/// Rates saturate towards `max_rate_per_mm`, harmonically, so that light inside a band is not turned without end. The loops over
/// families are free of branches and calls so that they vectorize; the few elements inside a band are mended afterwards.
template <int N>
OPAL_HD inline void reflection_rates(const BeamBlock& beams, const LaneOptics<N>& optics, real max_rate_per_mm,
                                     real (*rate_per_mm)[beam_block_size]) {
    real bragg_over_n_nm[beam_block_size], coupling[beam_block_size], detuning[beam_block_size], blocks_per_mm[beam_block_size];
    OPAL_SIMD
    for (int j = 0; j < beam_block_size; ++j) {
        const real cosine = max_of(beams.cosine[j], 1.0e-4f);
        bragg_over_n_nm[j] = 2.0f * cosine / beams.g_per_nm[j];
        coupling[j] = pi_f * beams.form[j] * polarization_factor(beams.polarized[j], cosine) * beams.block_nm[j] / cosine;
        detuning[j] = pi_f * beams.g_per_nm[j] * beams.block_nm[j];
        blocks_per_mm[j] = beams.share[j] * cosine * 1.0e6f / beams.block_nm[j];
    }
    real kappa_t[N][beam_block_size], delta_t[N][beam_block_size], lowest_x2[beam_block_size];
    for (int j = 0; j < beam_block_size; ++j) lowest_x2[j] = 3.0e38f;
    for (int i = 0; i < N; ++i) {
        const real n_over_lambda = optics.n_eff[i] / optics.wavelength_nm[i];
        const real strength = optics.contrast[i] / (optics.n_eff[i] * optics.wavelength_nm[i]);
        OPAL_SIMD
        for (int j = 0; j < beam_block_size; ++j) {
            const real ratio = bragg_over_n_nm[j] * n_over_lambda;
            const real near = ratio >= 0.5f && ratio <= 2.0f ? coupling[j] : 0.0f;
            kappa_t[i][j] = near * strength;
            delta_t[i][j] = detuning[j] * (ratio - 1.0f);
            const real kappa2 = kappa_t[i][j] * kappa_t[i][j];
            const real x2 = delta_t[i][j] * delta_t[i][j] - kappa2;
            lowest_x2[j] = x2 < lowest_x2[j] ? x2 : lowest_x2[j];
            const real outside = x2 < band_edge_x2 ? band_edge_x2 : x2;
            rate_per_mm[i][j] = blocks_per_mm[j] * kappa2 * sine_squared(sqrt(outside)) / outside;
        }
    }
    // Whether one is inside a band is asked of all at once.
    int in_band = 0;
    OPAL_SIMD_ANY(in_band)
    for (int j = 0; j < beam_block_size; ++j) in_band |= lowest_x2[j] < band_edge_x2;
    if (in_band)
        for (int i = 0; i < N; ++i)
            for (int j = 0; j < beam_block_size; ++j)
                if (delta_t[i][j] * delta_t[i][j] - kappa_t[i][j] * kappa_t[i][j] < band_edge_x2)
                    rate_per_mm[i][j] = blocks_per_mm[j] * block_reflection_odds(kappa_t[i][j], delta_t[i][j]);
    for (int i = 0; i < N; ++i) {
        OPAL_SIMD
        for (int j = 0; j < beam_block_size; ++j) rate_per_mm[i][j] *= max_rate_per_mm / (max_rate_per_mm + rate_per_mm[i][j]);
    }
}

}  // namespace opal
