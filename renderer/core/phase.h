// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/vec.h"

/// Phase functions in closed form: normalized over the sphere (1/sr), functions of the cosine between the directions of travel
/// before and after. Every sampler inverts its cumulative distribution, growing with u, so that even u give even cosines.
namespace opal {

/// Rayleigh phase function 3/(16 pi) (1 + cos^2); mean cosine 0.
OPAL_HD inline real rayleigh_phase(real cosine) {
    return (3.0f / (16.0f * pi_f)) * (1.0f + cosine * cosine);
}

/// Exact inversion of Rayleigh's cumulative distribution (Frisvad 2011, "Importance sampling the Rayleigh phase function"):
/// with v = 2 (2 u - 1) the cosine solves c^3 + 3 c = 2 v, whose real root is q - 1/q with q^3 = v + sqrt(v^2 + 1).
OPAL_HD inline real sample_rayleigh_cosine(real u) {
    const real v = 2.0f * (2.0f * u - 1.0f);
    const real q = cbrt(v + sqrt(v * v + 1.0f));
    return min_of(1.0f, max_of(-1.0f, q - 1.0f / q));
}

/// Henyey-Greenstein phase function with mean cosine g (Henyey & Greenstein 1941).
OPAL_HD inline real henyey_greenstein_phase(real cosine, real g) {
    // 1 + g^2 - 2 g cos without its cancellation at the peak.
    const real peak = 1.0f - fabs(g), away = 1.0f - (g < 0.0f ? -cosine : cosine);
    const real denominator = peak * peak + 2.0f * fabs(g) * away;
    return (1.0f - g * g) / (4.0f * pi_f * denominator * sqrt(denominator));
}

/// The inverse of Henyey-Greenstein's cumulative distribution in the form that has no singularity at g = 0, for g >= 0 and
/// y = 2 u: c = -1 + (1 + g)^2 y (2 e + g y) / (2 q^2) with e = 1 - g, q = e + g y.
OPAL_HD inline real forward_henyey_greenstein_cosine(real y, real g) {
    const real e = 1.0f - g, q = e + g * y;
    return -1.0f + 0.5f * square((1.0f + g) / q) * y * (2.0f * e + g * y);
}

OPAL_HD inline real sample_henyey_greenstein_cosine(real u, real g) {
    const real forward = forward_henyey_greenstein_cosine(2.0f * (g < 0.0f ? 1.0f - u : u), fabs(g));
    return min_of(1.0f, max_of(-1.0f, g < 0.0f ? -forward : forward));
}

/// Draine's phase function (Draine 2003, "Scattering by interstellar dust grains. I. Optical and ultraviolet", eq. 12): that of
/// Henyey and Greenstein times (1 + alpha cos^2), normalized. alpha 0 gives theirs, g 0 with alpha 1 Rayleigh's.
OPAL_HD inline real draine_phase(real cosine, real g, real alpha) {
    return henyey_greenstein_phase(cosine, g) * (1.0f + alpha * cosine * cosine) / (1.0f + alpha * (1.0f + 2.0f * g * g) / 3.0f);
}

/// Mean cosine of Draine's phase function (his eq. 13).
inline double draine_mean_cosine(double g, double alpha) {
    return g * (1.0 + alpha * (3.0 + 2.0 * g * g) / 5.0) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
}

/// Inverts Draine's cumulative distribution to rounding. Over y, the cumulative distribution of Henyey & Greenstein's part (see
/// forward_henyey_greenstein_cosine), the density is 1 + alpha c(y)^2; with e and q from there its integral from 0 is
///   y + alpha (y - 2 J1 + J2),  J1 = (1 + g)^2 y^2 / (2 q),  J2 = (1 + g)^4 y^3 (4 e + 3 g y) / (12 q^3),
/// the integrals of 1 + c and of its square: sums of positive terms alone. Newton's method finds y, held inside its bracket.
OPAL_HD inline real sample_draine_cosine(real u, real g, real alpha) {
    const real forward_g = fabs(g), e = 1.0f - forward_g, f = 1.0f + forward_g;
    const real total = 2.0f * (1.0f + alpha * (1.0f + 2.0f * g * g) / 3.0f);
    const real target = total * (g < 0.0f ? 1.0f - u : u);
    real low = 0.0f, high = 2.0f, y = 2.0f * target / total;
    // A step that Newton's would take out of the bracket halves it instead: 64 are past the last bit.
    for (int step = 0; step < 64; ++step) {
        const real slope = 1.0f + alpha * square(forward_henyey_greenstein_cosine(y, forward_g));
        const real ratio = f / (e + forward_g * y);
        const real first = 0.5f * ratio * f * y * y;
        const real second = ratio * ratio * ratio * f * y * y * y * (4.0f * e + 3.0f * forward_g * y) / 12.0f;
        const real excess = y + alpha * (y - 2.0f * first + second) - target;
        (excess > 0.0f ? high : low) = y;
        const real next = y - excess / slope;
        const bool converged = fabs(next - y) <= 3.0e-7f * y;
        y = converged || (next > low && next < high) ? next : 0.5f * (low + high);
        if (converged) break;
    }
    const real cosine = forward_henyey_greenstein_cosine(y, forward_g);
    return min_of(1.0f, max_of(-1.0f, g < 0.0f ? -cosine : cosine));
}

/// Schlick's phase function (Blasi, Le Saec & Schlick 1993, "A rendering algorithm for discrete volume density objects"):
/// (1 - k^2) / (4 pi (1 - k cos)^2), forwards for k > 0.
OPAL_HD inline real schlick_phase(real cosine, real k) {
    const real peak = 1.0f - fabs(k), away = 1.0f - (k < 0.0f ? -cosine : cosine);
    return (1.0f - k * k) / (4.0f * pi_f * square(peak + fabs(k) * away));
}

OPAL_HD inline real sample_schlick_cosine(real u, real k) {
    const real forward_k = fabs(k), v = k < 0.0f ? 1.0f - u : u, e = 1.0f - forward_k;
    const real forward = -1.0f + 2.0f * v * (1.0f + forward_k) / (e + 2.0f * forward_k * v);
    return min_of(1.0f, max_of(-1.0f, k < 0.0f ? -forward : forward));
}

/// Mean cosine of Schlick's phase function: 1/k - (1 - k^2) artanh(k) / k^2.
inline double schlick_mean_cosine(double k) {
    if (fabs(k) < 1.0e-2) return k * (2.0 / 3.0 + k * k * 2.0 / 15.0);
    return 1.0 / k - (1.0 - k * k) * atanh(k) / (k * k);
}

/// Direction at a given cosine to `direction` and azimuth 2 pi u.
OPAL_HD inline Vec3 deflect(Vec3 direction, real cosine, real u) {
    const real sine = sqrt(max_of(0.0f, 1.0f - cosine * cosine));
    const real azimuth_rad = 2.0f * pi_f * u;
    return normalize(Frame(direction).world_from_local({sine * cos(azimuth_rad), sine * sin(azimuth_rad), cosine}));
}

}  // namespace opal
