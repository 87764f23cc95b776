// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/compat.h"

/// The two diffraction models that two-beam theory is compared with: the kinematic sum over a finite number of planes (Laue), and
/// the Ewald sphere with a tolerance and a Fresnel reflectance. Templates on the real type: the same formulas serve the renderer
/// in its precision and the tables in double.
namespace opal {

template <typename Real>
struct PolarizedReflectance {
    Real s, p;
};

/// sin^2(N x) / sin^2(x), the Laue interference function of N planes (James, "The Optical Principles of the Diffraction of
/// X-rays", 1948, chapter I), N^2 at its maximum x = 0. For |x| <= pi / 2, where that maximum is the only one; N need not be
/// whole.
template <typename Real>
OPAL_HD inline Real laue_interference(Real x, Real layers) {
    const Real nx = layers * x;
    if (nx * nx < Real(1e-5)) return layers * layers * (Real(1) - (layers * layers - Real(1)) * x * x / Real(3));
    const Real ratio = sin(nx) / sin(x);
    return ratio * ratio;
}

/// Reflectance of `layers` planes that each reflect with amplitude kappa D and none of which weakens the beam for the next
/// (kinematic, single scattering): (kappa D)^2 sin^2(N x) / sin^2(x), x = delta D the detuning per plane. That sum passes 1 where
/// kappa t does, the limit of its validity; it is cut there: min(1, ...). `delta_d` = pi (lambda_B / lambda - 1); beyond pi / 2
/// another order of the same planes is nearer, which is a family of its own: nothing is reflected.
template <typename Real>
OPAL_HD inline Real laue_reflectance(Real kappa_d, Real delta_d, Real layers) {
    if (delta_d > Real(1.5707963267948966) || delta_d < Real(-1.5707963267948966)) return Real(0);
    const Real sum = kappa_d * kappa_d * laue_interference(delta_d, layers);
    return sum < Real(1) ? sum : Real(1);
}

/// | |w + (lambda / n) G| - 1 |, how far the reciprocal vector G misses the Ewald sphere of the unit direction w; `cosine` = |w .
/// g| with w . G < 0, `detuning` = lambda / lambda_B - 1. The squared length is 1 + 4 c^2 (1 + detuning) detuning: written
/// without the cancellation of two numbers near 1.
template <typename Real>
OPAL_HD inline Real ewald_miss(Real detuning, Real cosine) {
    const Real excess = Real(4) * cosine * cosine * (Real(1) + detuning) * detuning;
    const Real squared_length = Real(1) + excess;
    const Real miss = excess / (sqrt(squared_length > Real(0) ? squared_length : Real(0)) + Real(1));
    return miss < Real(0) ? -miss : miss;
}

/// Fresnel reflectance of the interface from the medium to the spheres, `eta` = n_sphere / n_medium, at incidence cosine `cosine`
/// (Born & Wolf, section 1.5.2); 1 under total internal reflection.
template <typename Real>
OPAL_HD inline PolarizedReflectance<Real> polarized_fresnel(Real cosine, Real eta) {
    const Real sin2_transmitted = (Real(1) - cosine * cosine) / (eta * eta);
    if (sin2_transmitted >= Real(1)) return {Real(1), Real(1)};
    const Real transmitted = sqrt(Real(1) - sin2_transmitted);
    const Real s = (cosine - eta * transmitted) / (cosine + eta * transmitted);
    const Real p = (eta * cosine - transmitted) / (eta * cosine + transmitted);
    return {s * s, p * p};
}

/// The rule "every G on the Ewald sphere reflects with the Fresnel reflectance at half the scattering angle", made definite: on
/// the sphere is what misses it by less than `tolerance`, half the angle between the returned and the incident ray is the angle
/// between the ray and the planes' normal, and the interface is the one from the medium to the spheres. The reflected energy
/// grows in proportion to the tolerance and knows neither the spheres' form factor nor the thickness.
template <typename Real>
OPAL_HD inline PolarizedReflectance<Real> ewald_fresnel_reflectance(Real detuning, Real cosine, Real eta, Real tolerance) {
    if (!(ewald_miss(detuning, cosine) < tolerance)) return {Real(0), Real(0)};
    return polarized_fresnel(cosine, eta);
}

}  // namespace opal
