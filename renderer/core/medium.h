// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/lane_weights.h"
#include "renderer/core/path_random.h"
#include "renderer/core/phase_function.h"

/// Absorption and scattering of the opal's body along a path.
namespace opal {

/// The opal's body as the transport reads it.
struct MediumView {
    const float* sigma_a_per_mm = nullptr;  ///< 1 nm table
    float sigma_s_rayleigh_400nm_per_mm = 0.0f;
    const float* sigma_s_mie_per_mm = nullptr;  ///< 1 nm table
    PhaseFunctionView mie_phase;
};

/// Its coefficients for the lanes of a path, per mm.
template <int N>
struct LaneMedium {
    Lanes<N> sigma_a, sigma_rayleigh, sigma_mie;

    OPAL_HD float sigma_s(int lane) const { return sigma_rayleigh.v[lane] + sigma_mie.v[lane]; }
};

template <int N>
OPAL_HD inline LaneMedium<N> lane_medium(const MediumView& view, const PathWavelengths<N>& wavelengths) {
    LaneMedium<N> medium;
    for (int i = 0; i < N; ++i) {
        const float wavelength_nm = wavelengths.wavelength_nm[i];
        const float relative = 400.0f / wavelength_nm;
        medium.sigma_a.v[i] = table_at(view.sigma_a_per_mm, wavelength_nm);
        medium.sigma_rayleigh.v[i] = view.sigma_s_rayleigh_400nm_per_mm * square(square(relative));
        medium.sigma_mie.v[i] = table_at(view.sigma_s_mie_per_mm, wavelength_nm);
    }
    return medium;
}

/// One straight flight through the medium, followed piece by piece. Absorption goes into the throughput; every lane's probability
/// of not having scattered into its ratio.
template <int N>
class MediumFlight {
  public:
    OPAL_HD MediumFlight(const LaneMedium<N>& medium, PathRandom& random) : medium_(medium) {
        const float sigma_s = medium.sigma_s(0);
        scatter_mm_ = sigma_s > 0.0f ? -logf(1.0f - random.next()) / sigma_s : 3.0e38f;
    }

    /// Goes on to `distance_mm` from the flight's start, or to where the hero scatters before that. Returns the distance reached.
    OPAL_HD float advance(float distance_mm, LaneWeights<N>& weights) {
        const float end_mm = min_of(distance_mm, scatter_mm_);
        const float step_mm = end_mm - reached_mm_;
        for (int i = 0; i < weights.count; ++i) weights.throughput.v[i] *= expf(-medium_.sigma_a.v[i] * step_mm);
        for (int i = 1; i < weights.count; ++i) weights.ratio.v[i] *= expf((medium_.sigma_s(0) - medium_.sigma_s(i)) * step_mm);
        reached_mm_ = end_mm;
        return end_mm;
    }

    /// Whether the flight ended by scattering at the distance that `advance` returned.
    OPAL_HD bool scattered() const { return reached_mm_ == scatter_mm_; }

    /// The hero's coefficients where it scattered, and the lanes'.
    OPAL_HD const LaneMedium<N>& local() const { return medium_; }

  private:
    const LaneMedium<N>& medium_;
    float scatter_mm_;
    float reached_mm_ = 0.0f;
};

/// Draws the direction after a scattering and weighs the lanes by how likely each was to scatter so. Rayleigh's phase function is
/// the same at every wavelength; the other may not be.
template <int N>
OPAL_HD inline Vec3 scatter_direction(const MediumView& view, const PathWavelengths<N>& wavelengths, const LaneMedium<N>& local,
                                      Vec3 direction, LaneWeights<N>& weights, PathRandom& random) {
    const bool rayleigh = random.next() * local.sigma_s(0) < local.sigma_rayleigh.v[0];
    const Lanes<N>& chosen = rayleigh ? local.sigma_rayleigh : local.sigma_mie;
    for (int i = 1; i < weights.count; ++i) weights.ratio.v[i] *= chosen.v[i] / chosen.v[0];
    const float u = random.next();
    if (rayleigh) return deflect(direction, sample_rayleigh_cosine(u), random.next());
    const PhaseFunctionView& phase = view.mie_phase;
    const float cosine = sample_phase_cosine(phase, wavelengths.wavelength_nm[0], u, phase_varies(phase) ? random.next() : 0.0f);
    if (phase_varies(phase)) {
        const float hero = phase_density(phase, cosine, wavelengths.wavelength_nm[0]);
        for (int i = 1; i < weights.count; ++i)
            weights.ratio.v[i] *= phase_density(phase, cosine, wavelengths.wavelength_nm[i]) / hero;
    }
    return deflect(direction, cosine, random.next());
}

}  // namespace opal
