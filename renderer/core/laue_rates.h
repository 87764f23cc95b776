// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/diffraction_models.h"
#include "renderer/core/two_beam.h"

namespace opal {

/// What reflection_rates is for two-beam theory, for the kinematic sum over the planes of one block: the block's reflectance is
/// the Laue interference function, cut at 1. For comparison.
template <int N>
OPAL_HD inline void laue_rates(const BeamBlock& beams, const LaneOptics<N>& optics, real max_rate_per_mm,
                               real (*rate_per_mm)[beam_block_size]) {
    for (int j = 0; j < beam_block_size; ++j) {
        const real cosine = max_of(beams.cosine[j], 1.0e-4f);
        const real planes = beams.block_nm[j] * beams.g_per_nm[j];
        const real factor = polarization_factor(beams.polarized[j], cosine);
        const real blocks_per_mm = beams.share[j] * cosine * 1.0e6f / beams.block_nm[j];
        for (int i = 0; i < N; ++i) {
            const real n_lambda = optics.n_eff[i] * optics.wavelength_nm[i];
            const real kappa_d = pi_f * beams.form[j] * factor * optics.contrast[i] / (n_lambda * cosine * beams.g_per_nm[j]);
            const real ratio = 2.0f * cosine * optics.n_eff[i] / (beams.g_per_nm[j] * optics.wavelength_nm[i]);
            // A block that reflects everything has infinite odds; they saturate all the same.
            const real reflectance = min_of(laue_reflectance(kappa_d, pi_f * (ratio - 1.0f), planes), 0.999999f);
            const real rate = blocks_per_mm * reflectance / (1.0f - reflectance);
            rate_per_mm[i][j] = rate * max_rate_per_mm / (max_rate_per_mm + rate);
        }
    }
}

}  // namespace opal
