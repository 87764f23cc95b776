// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/field_lookup.h"
#include "renderer/core/lane_weights.h"
#include "renderer/core/majorant_view.h"
#include "renderer/core/path_random.h"
#include "renderer/core/phase_function.h"

/// Absorption and scattering of the opal's body along a path.
namespace opal {

/// The opal's body as the transport reads it: coefficients, and the fields that multiply them where they vary.
struct MediumView {
    const float* sigma_a_per_mm = nullptr;  ///< 1 nm table
    real sigma_s_rayleigh_400nm_per_mm = 0.0f;
    const float* sigma_s_mie_per_mm = nullptr;  ///< 1 nm table
    PhaseFunctionView mie_phase;
    FieldView fields[num_medium_fields];
    MajorantView majorants;  ///< of the fields; no cells where nothing varies
};

/// Its coefficients for the lanes of a path, per mm; where a field varies, per unit of the field.
template <int N>
struct LaneMedium {
    Lanes<N> sigma_a, sigma_rayleigh, sigma_mie;

    OPAL_HD real sigma_s(int lane) const { return sigma_rayleigh.v[lane] + sigma_mie.v[lane]; }
};

template <int N>
OPAL_HD inline LaneMedium<N> lane_medium(const MediumView& view, const PathWavelengths<N>& wavelengths) {
    LaneMedium<N> medium;
    for (int i = 0; i < N; ++i) {
        const real wavelength_nm = wavelengths.wavelength_nm[i];
        const real relative = 400.0f / wavelength_nm;
        medium.sigma_a.v[i] = table_at(view.sigma_a_per_mm, wavelength_nm);
        medium.sigma_rayleigh.v[i] = view.sigma_s_rayleigh_400nm_per_mm * square(square(relative));
        medium.sigma_mie.v[i] = table_at(view.sigma_s_mie_per_mm, wavelength_nm);
    }
    return medium;
}

/// Draws the direction after a scattering and weighs the lanes by how likely each was to scatter so. Rayleigh's phase function is
/// the same at every wavelength; the other may not be.
template <int N>
OPAL_HD inline Vec3 scatter_direction(const MediumView& view, const PathWavelengths<N>& wavelengths, const LaneMedium<N>& local,
                                      Vec3 direction, LaneWeights<N>& weights, PathRandom& random) {
    const bool rayleigh = random.next() * local.sigma_s(0) < local.sigma_rayleigh.v[0];
    const Lanes<N>& chosen = rayleigh ? local.sigma_rayleigh : local.sigma_mie;
    for (int i = 1; i < weights.count; ++i) weights.ratio.v[i] *= chosen.v[i] / chosen.v[0];
    const real u = random.next();
    if (rayleigh) return deflect(direction, sample_rayleigh_cosine(u), random.next());
    const PhaseFunctionView& phase = view.mie_phase;
    const real cosine = sample_phase_cosine(phase, wavelengths.wavelength_nm[0], u, phase_varies(phase) ? random.next() : 0.0f);
    if (phase_varies(phase)) {
        const real hero = phase_density(phase, cosine, wavelengths.wavelength_nm[0]);
        for (int i = 1; i < weights.count; ++i)
            weights.ratio.v[i] *= phase_density(phase, cosine, wavelengths.wavelength_nm[i]) / hero;
    }
    return deflect(direction, cosine, random.next());
}

}  // namespace opal
