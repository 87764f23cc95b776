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

/// One family of planes met at a given angle: everything but the wavelength.
struct BeamGeometry {
    float cosine;    ///< |w . g|, direction of travel against the planes' normal
    float g_per_nm;  ///< |G|
    float epsilon;   ///< |eps_G|
    float n_eff;
    float block_nm;  ///< thickness of one coherent block along the normal
    float blocks;    ///< how many of them the path through the grain crosses, at least 1
};

/// Blocks of a path of length `chord_nm` through a grain whose coherent blocks are `coherence_nm` thick along the planes' normal:
/// a shorter crossing is one thinner block.
OPAL_HD inline void set_blocks(BeamGeometry& beam, float chord_nm, float coherence_nm) {
    const float depth_nm = chord_nm * beam.cosine;
    beam.block_nm = min_of(coherence_nm, depth_nm);
    beam.blocks = max_of(1.0f, depth_nm / coherence_nm);
}

/// Reflection odds N = R / (1 - R) of a pile of incoherently stacked blocks, for every lane and both polarizations: elements 0..3
/// are s, 4..7 are p. R = M r / (1 + (M - 1) r) is the same as N = M r / (1 - r), so a fraction x of the path has odds x N.
struct PileOdds {
    static constexpr int size = 2 * num_lanes;
    float odds[size];

    OPAL_HD float s(int lane) const { return odds[lane]; }
    OPAL_HD float p(int lane) const { return odds[num_lanes + lane]; }
    /// Reflectance averaged over the polarizations, at a fraction of the path.
    OPAL_HD float reflectance(int lane, float fraction = 1.0f) const {
        const float a = fraction * s(lane), b = fraction * p(lane);
        return 0.5f * (a / (1.0f + a) + b / (1.0f + b));
    }
    /// Its derivative with respect to the fraction: the density of where on the path the light turns.
    OPAL_HD float turning_density(int lane, float fraction) const {
        const float a = 1.0f + fraction * s(lane), b = 1.0f + fraction * p(lane);
        return 0.5f * (s(lane) / (a * a) + p(lane) / (b * b));
    }
};

/// Fills the odds of a pile. Coupling kappa = pi |eps_G| C / (n lambda c), C = 1 (s) or |1 - 2 c^2| (p); detuning
/// delta = 2 pi (n c / lambda - |G| / 2) = pi |G| (lambda_B / lambda - 1) (two-beam dynamical diffraction, Zachariasen 1945).
/// More than an octave from the Bragg wavelength the two-beam picture (one strong G near its Bragg condition) does not hold, and
/// grazing passes would get a coupling that grows without bound: nothing is reflected there. Returns false where that is so for
/// every lane. The loops are free of branches and calls so that they vectorize; the few elements inside the band are mended
/// afterwards.
OPAL_HD inline bool pile_odds(const BeamGeometry& beam, const float* wavelength_nm, PileOdds& result) {
    const float bragg_nm = 2.0f * beam.n_eff * beam.cosine / beam.g_per_nm;
    const float coupling = pi_f * beam.epsilon * beam.block_nm / (beam.n_eff * beam.cosine);
    const float p_factor = fabsf(1.0f - 2.0f * beam.cosine * beam.cosine);
    float ratio[num_lanes];
    bool any_near = false;
    for (int i = 0; i < num_lanes; ++i) {
        ratio[i] = bragg_nm / wavelength_nm[i];
        any_near = any_near || (ratio[i] >= 0.5f && ratio[i] <= 2.0f);
    }
    if (!any_near) return false;

    float kappa_t[PileOdds::size], delta_t[PileOdds::size], x2[PileOdds::size];
    const float detuning = pi_f * beam.g_per_nm * beam.block_nm;
    OPAL_SIMD
    for (int i = 0; i < num_lanes; ++i) {
        const float near = ratio[i] >= 0.5f && ratio[i] <= 2.0f ? coupling : 0.0f;
        kappa_t[i] = near / wavelength_nm[i];
        kappa_t[num_lanes + i] = kappa_t[i] * p_factor;
        delta_t[i] = detuning * (ratio[i] - 1.0f);
        delta_t[num_lanes + i] = delta_t[i];
    }
    OPAL_SIMD
    for (int i = 0; i < PileOdds::size; ++i) {
        const float kappa2 = kappa_t[i] * kappa_t[i];
        x2[i] = delta_t[i] * delta_t[i] - kappa2;
        const float outside = x2[i] < band_edge_x2 ? band_edge_x2 : x2[i];
        result.odds[i] = beam.blocks * kappa2 * sine_squared(sqrtf(outside)) / outside;
    }
    float smallest = x2[0];
    for (int i = 1; i < PileOdds::size; ++i) smallest = min_of(smallest, x2[i]);
    if (smallest < band_edge_x2)
        for (int i = 0; i < PileOdds::size; ++i)
            if (x2[i] < band_edge_x2) result.odds[i] = beam.blocks * block_reflection_odds(kappa_t[i], delta_t[i]);
    return true;
}

}  // namespace opal
