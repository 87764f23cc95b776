// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace opal {

/// Two-beam dynamical reflectance of one coherent block in double precision (Zachariasen, "Theory of X-Ray Diffraction in
/// Crystals", 1945, chapter III):
///   r = kappa^2 sinh^2(gamma t) / (gamma^2 cosh^2(gamma t) + delta^2 sinh^2(gamma t)),  gamma^2 = kappa^2 - delta^2,
/// sin for sinh outside the band. Written as (kappa t)^2 / ((kappa t)^2 + x^2 / sinh^2 x) with x = gamma t, which neither
/// overflows nor divides by zero. `kappa_t`, `delta_t`: coupling and detuning times the thickness.
inline double two_beam_reflectance(double kappa_t, double delta_t) {
    const double kappa2 = kappa_t * kappa_t;
    const double x2 = (kappa_t - delta_t) * (kappa_t + delta_t);
    if (std::abs(x2) < 1.0e-6) return kappa2 / (kappa2 + 1.0 - x2 / 3.0);
    const double x = std::sqrt(std::abs(x2));
    if (x2 > 0.0) {
        const double ratio = x / std::sinh(x);
        return kappa2 / (kappa2 + ratio * ratio);
    }
    const double sine = std::sin(x);
    return kappa2 * sine * sine / (kappa2 * sine * sine - x2);
}

/// Reflectance of `blocks` such blocks one behind the other, whose waves do not interfere (intragrain disorder): the two beams
/// between them add as intensities, M r / (1 + (M - 1) r).
inline double pile_reflectance(double reflectance, double blocks) {
    return blocks * reflectance / (1.0 + (blocks - 1.0) * reflectance);
}

}  // namespace opal
