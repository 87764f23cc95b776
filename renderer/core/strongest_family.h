// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/scene_view.h"

/// Which family of lattice planes shows in a grain: a deterministic answer for pictures of families.
namespace opal {

/// What a family does to white light that crosses a grain.
struct FamilyTurn {
    int pair = -1;              ///< of OpalView::pairs; -1: none turns any light
    bool towards_g = false;     ///< the reciprocal vector that turns the light is the pair's own, not its opposite
    real turned = 0.0f;         ///< X + Y + Z turned, under the scene's illuminant (white: X + Y + Z near 3)
    real wavelength_nm = 0.0f;  ///< mean of what is turned, weighted as `turned` is
};

/// Half widths of a band on each side that are looked at, and wavelengths in each half of it.
inline constexpr real family_band_half_widths = 3.0f;
inline constexpr int family_band_lanes = 8, family_band_batches = 3;

/// Light that one family turns within `chord_mm`: reflectance of a pile, r L / (1 + r L) with two-beam theory's rate r for blocks
/// of mean thickness, averaged over both polarizations, times illuminant times observer, summed over its band.
OPAL_HD inline FamilyTurn turn_by_family(const OpalView& opal, const SpectrumTables& spectra, int pair_index,
                                         Vec3 lattice_direction, real chord_mm, real size_mm) {
    const PlanePair& pair = opal.pairs[pair_index];
    const real along = dot(lattice_direction, pair.normal);
    const real cosine = fabs(along);
    FamilyTurn turn;
    if (cosine < 1.0e-3f) return turn;
    // Bragg's law with an index that varies slowly: two rounds settle it.
    real bragg_nm = 589.0f;
    for (int round = 0; round < 3; ++round) bragg_nm = 2.0f * cosine * table_at(opal.n_eff, bragg_nm) / pair.g_per_nm;
    if (!(bragg_nm > spectrum_min_nm && bragg_nm < spectrum_max_nm)) return turn;
    const real block_nm = min_of(min_of(opal.coherence_nm, pair.coherence_nm), size_mm * 1.0e6f);
    const real coupling =
        pair.form * table_at(opal.contrast, bragg_nm) * block_nm / (table_at(opal.n_eff, bragg_nm) * bragg_nm * cosine);
    const real half_width_nm = bragg_nm * (1.0f + coupling) / (pair.g_per_nm * block_nm);
    const real step_nm = 2.0f * family_band_half_widths * half_width_nm / real(family_band_lanes * family_band_batches);
    real sum_nm = 0.0f;
    for (int batch = 0; batch < family_band_batches; ++batch) {
        LaneOptics<family_band_lanes> optics;
        real response[family_band_lanes];
        for (int i = 0; i < family_band_lanes; ++i) {
            const real place = real(batch * family_band_lanes + i) + 0.5f - 0.5f * real(family_band_lanes * family_band_batches);
            const real wavelength_nm = bragg_nm + place * step_nm;
            const Vec3 observer = table_at(spectra.observer, wavelength_nm);
            const bool visible = wavelength_nm > spectrum_min_nm && wavelength_nm < spectrum_max_nm;
            response[i] = visible ? table_at(spectra.white, wavelength_nm) * (observer.x + observer.y + observer.z) : 0.0f;
            optics.wavelength_nm[i] = wavelength_nm;
            optics.n_eff[i] = table_at(opal.n_eff, wavelength_nm);
            optics.contrast[i] = table_at(opal.contrast, wavelength_nm);
        }
        for (const bool p_polarized : {false, true}) {
            const BeamBlock beam = single_beam(cosine, pair.g_per_nm, pair.form, block_nm, p_polarized);
            real rate_per_mm[family_band_lanes][beam_block_size];
            reflection_rates(beam, optics, opal.max_odds / size_mm, rate_per_mm);
            for (int i = 0; i < family_band_lanes; ++i) {
                const real odds = rate_per_mm[i][0] * chord_mm;
                const real turned = 0.5f * response[i] * step_nm * odds / (1.0f + odds);
                turn.turned += turned;
                sum_nm += turned * optics.wavelength_nm[i];
            }
        }
    }
    if (!(turn.turned > 0.0f)) return {};
    turn.pair = pair_index;
    turn.wavelength_nm = sum_nm / turn.turned;
    // The reciprocal vector is what the direction changes by: against the component along the pair's normal.
    turn.towards_g = along < 0.0f;
    return turn;
}

/// The family that turns most of the light that crosses `chord_mm` of a grain along `direction` (world, unit).
OPAL_HD inline FamilyTurn strongest_family(const OpalView& opal, const SpectrumTables& spectra, int grain, Vec3 direction,
                                           real chord_mm) {
    const Vec3 lattice_direction =
        opal.orientations[grain - 1].conjugate().rotate(opal.world_from_object.local_from_world_direction(direction));
    const real size_mm = opal.grain_size_mm[grain - 1] * opal.world_from_object.scale;
    FamilyTurn strongest;
    for (int k = 0; k < opal.num_pairs; ++k) {
        const FamilyTurn turn = turn_by_family(opal, spectra, k, lattice_direction, chord_mm, size_mm);
        if (turn.turned > strongest.turned) strongest = turn;
    }
    return strongest;
}

}  // namespace opal
