// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/diffraction_models.h"
#include "renderer/core/path_random.h"
#include "renderer/core/scene_view.h"

/// The rule of the Ewald sphere with a tolerance: at a grain's boundary, the families whose reciprocal vector ends on the sphere
/// of the light's direction are candidates; one is picked, and reflects with a Fresnel reflectance. For comparison: brightness is
/// in proportion to the tolerance, and all families are alike.
namespace opal {

/// Chance of a turn for one lane, and, for a number `u` uniform in [0, 1) below that chance, by which family.
struct EwaldChance {
    real probability = 0.0f;
    int pair = -1;
};

template <int N>
OPAL_HD inline EwaldChance ewald_chance(const OpalView& opal, const LaneOptics<N>& optics, int lane, Vec3 lattice_direction,
                                        real u) {
    int candidates[max_tested_pairs];
    real reflectances[max_tested_pairs];
    int count = 0;
    real sum = 0.0f;
    for (int k = 0; k < opal.num_pairs; ++k) {
        const PlanePair& pair = opal.pairs[k];
        const real cosine = fabs(dot(lattice_direction, pair.normal));
        if (cosine < 1.0e-4f) continue;
        const real bragg_nm = 2.0f * optics.n_eff[lane] * cosine / pair.g_per_nm;
        const PolarizedReflectance<real> reflectance = ewald_fresnel_reflectance(
            optics.wavelength_nm[lane] / bragg_nm - 1.0f, cosine, optics.relative_index[lane], opal.ewald_tolerance);
        if (!(ewald_miss(optics.wavelength_nm[lane] / bragg_nm - 1.0f, cosine) < opal.ewald_tolerance)) continue;
        candidates[count] = k;
        reflectances[count] = 0.5f * (reflectance.s + reflectance.p);
        sum += reflectances[count++];
    }
    EwaldChance chance;
    if (count == 0) return chance;
    chance.probability = sum / real(count);
    real rest = u * real(count);
    for (int i = 0; i < count && chance.pair < 0; ++i) {
        if (rest < reflectances[i]) chance.pair = candidates[i];
        rest -= reflectances[i];
    }
    return chance;
}

/// w + (lambda / n) G for the sense of G that faces the light, made unit: `direction` and `normal` in the same frame.
OPAL_HD inline Vec3 ewald_direction(Vec3 direction, Vec3 normal, real g_per_nm, real wavelength_in_medium_nm) {
    const real sense = dot(direction, normal) > 0.0f ? -1.0f : 1.0f;
    return normalize(direction + (sense * wavelength_in_medium_nm * g_per_nm) * normal);
}

}  // namespace opal
