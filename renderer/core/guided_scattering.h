// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/light_guide.h"
#include "renderer/core/medium.h"

namespace opal {

/// Share of the directions that the guide draws; the phase functions draw the rest, so that no weight exceeds 1 / (1 - share).
inline constexpr real guide_share = 0.5f;
/// Scatterings of a path that are guided. Weights multiply over scatterings: in dense bodies the light would end up in samples so
/// rare and so heavy that a picture of any affordable length misses it. Light that the eye sees sharply has scattered once or
/// twice.
inline constexpr int most_guided_scatterings = 2;

/// Density (1/sr) of scattering into a direction, given that light scatters: Rayleigh's and the other phase function by their
/// shares.
OPAL_HD inline real phase_mixture(const MediumView& view, real sigma_rayleigh, real sigma_mie, real cosine, real wavelength_nm) {
    real sum = 0.0f;
    if (sigma_rayleigh > 0.0f) sum += sigma_rayleigh * rayleigh_phase(cosine);
    if (sigma_mie > 0.0f) sum += sigma_mie * phase_density(view.mie_phase, cosine, wavelength_nm);
    return sum > 0.0f ? sum / (sigma_rayleigh + sigma_mie) : 0.0f;
}

/// As scatter_direction, with half of the directions drawn from the guide. Each lane's weight is its phase function over its own
/// density of drawing, the mixture of both ways, and its ratio takes that density over the hero's.
template <int N>
OPAL_HD inline Vec3 guided_scatter_direction(const MediumView& view, const LightGuideView& guide, Vec3 position_mm,
                                             const PathWavelengths<N>& wavelengths, const LaneMedium<N>& local, Vec3 direction,
                                             LaneWeights<N>& weights, PathRandom& random) {
    const real choice = random.next(), u1 = random.next(), u2 = random.next();
    const GuidedDirections directions(guide, position_mm, direction);
    const real share = directions.known() ? guide_share : 0.0f;
    ++weights.guided_scatterings;
    Vec3 turned;
    if (choice < share) {
        turned = directions.sample(u1, u2);
    } else {
        const bool rayleigh = (choice - share) / (1.0f - share) * local.sigma_s(0) < local.sigma_rayleigh.v[0];
        const PhaseFunctionView& phase = view.mie_phase;
        const real cosine =
            rayleigh ? sample_rayleigh_cosine(u1)
                     : sample_phase_cosine(phase, wavelengths.wavelength_nm[0], u1, phase_varies(phase) ? random.next() : 0.0f);
        turned = deflect(direction, cosine, u2);
    }
    const real cosine = max_of(-1.0f, min_of(1.0f, dot(direction, turned)));
    const real guided = share > 0.0f ? share * directions.pdf(turned) : 0.0f;
    real density[N];
    for (int i = 0; i < weights.count; ++i) {
        const real phase =
            phase_mixture(view, local.sigma_rayleigh.v[i], local.sigma_mie.v[i], cosine, wavelengths.wavelength_nm[i]);
        density[i] = (1.0f - share) * phase + guided;
        weights.throughput.v[i] *= density[i] > 0.0f ? phase / density[i] : 0.0f;
    }
    for (int i = 1; i < weights.count; ++i) weights.ratio.v[i] *= local.sigma_s(i) * density[i] / (local.sigma_s(0) * density[0]);
    return turned;
}

}  // namespace opal
