// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/diffraction_models.h"
#include "renderer/core/two_beam.h"

namespace opal {

/// What reflection_rates is for two-beam theory, for the kinematic sum over the planes of one block: the block's reflectance is
/// the Laue interference function, cut at 1. For comparison.
template <int N>
OPAL_HD inline bool laue_rates(const BeamGeometry& beam, const LaneOptics<N>& optics, float max_rate_per_mm, float* rate_per_mm) {
    const float planes = beam.block_nm * beam.g_per_nm;
    const float factor = beam.p_polarized ? fabsf(1.0f - 2.0f * beam.cosine * beam.cosine) : 1.0f;
    const float blocks_per_mm = beam.share * beam.cosine * 1.0e6f / beam.block_nm;
    bool any = false;
    for (int i = 0; i < N; ++i) {
        const float n_lambda = optics.n_eff[i] * optics.wavelength_nm[i];
        const float kappa_d = pi_f * beam.form * factor * optics.contrast[i] / (n_lambda * beam.cosine * beam.g_per_nm);
        const float ratio = 2.0f * beam.cosine * optics.n_eff[i] / (beam.g_per_nm * optics.wavelength_nm[i]);
        // A block that reflects everything has infinite odds; they saturate all the same.
        const float reflectance = min_of(laue_reflectance(kappa_d, pi_f * (ratio - 1.0f), planes), 0.999999f);
        const float rate = blocks_per_mm * reflectance / (1.0f - reflectance);
        rate_per_mm[i] = rate * max_rate_per_mm / (max_rate_per_mm + rate);
        any = any || rate > 0.0f;
    }
    return any;
}

}  // namespace opal
