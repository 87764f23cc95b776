// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/vec.h"

/// Phase functions: normalized over the sphere, functions of the cosine between the directions of travel before and after.
namespace opal {

/// Rayleigh phase function 3/(16 pi) (1 + cos^2).
OPAL_HD inline float rayleigh_phase(float cosine) {
    return (3.0f / (16.0f * pi_f)) * (1.0f + cosine * cosine);
}

/// Exact inversion of Rayleigh's cumulative distribution (Frisvad 2011, "Importance sampling the Rayleigh phase function"):
/// with v = 2 (2 u - 1) the cosine solves c^3 + 3 c = 2 v, whose real root is q - 1/q with q^3 = v + sqrt(v^2 + 1).
OPAL_HD inline float sample_rayleigh_cosine(float u) {
    const float v = 2.0f * (2.0f * u - 1.0f);
    const float q = cbrtf(v + sqrtf(v * v + 1.0f));
    return min_of(1.0f, max_of(-1.0f, q - 1.0f / q));
}

/// Henyey-Greenstein phase function with mean cosine g (Henyey & Greenstein 1941).
OPAL_HD inline float henyey_greenstein_phase(float cosine, float g) {
    const float denominator = 1.0f + g * g - 2.0f * g * cosine;
    return (1.0f - g * g) / (4.0f * pi_f * denominator * sqrtf(denominator));
}

OPAL_HD inline float sample_henyey_greenstein_cosine(float u, float g) {
    if (fabsf(g) < 1.0e-3f) return 1.0f - 2.0f * u;
    const float s = (1.0f - g * g) / (1.0f - g + 2.0f * g * u);
    return min_of(1.0f, max_of(-1.0f, (1.0f + g * g - s * s) / (2.0f * g)));
}

/// Direction at a given cosine to `direction` and azimuth 2 pi u.
OPAL_HD inline Vec3 deflect(Vec3 direction, float cosine, float u) {
    const float sine = sqrtf(max_of(0.0f, 1.0f - cosine * cosine));
    const float azimuth_rad = 2.0f * pi_f * u;
    return normalize(Frame(direction).world_from_local({sine * cosf(azimuth_rad), sine * sinf(azimuth_rad), cosine}));
}

}  // namespace opal
