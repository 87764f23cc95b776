// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/laue_rates.h"
#include "renderer/core/mosaic.h"
#include "renderer/core/path_random.h"
#include "renderer/core/scene_view.h"

/// A stay in one grain. Light that a family of planes turns meets the same family again at the same angle, is turned back, and so
/// on: a random walk between beams, which ends where the light leaves the grain or scatters. What is random about the grain
/// itself is drawn once per stay.
namespace opal {

/// Turning rates of every family that matters along one direction.
template <int N>
struct GrainRates {
    real rate_per_mm[N][max_tested_pairs];  ///< per lane; element i is that of family pair[i]
    int pair[max_tested_pairs];
    int count = 0;
    real total_per_mm[N];
    Vec3 direction;  ///< world
};

template <int N>
struct GrainVisit {
    int grain = 0;                   ///< 0: not known yet
    int cell = -1;                   ///< where the light is, or nearly; -1: not known, or grains are not made of cells
    bool fresh = true;               ///< nothing below is drawn yet
    bool at_boundary = false;        ///< the stay begins where the light comes in from outside the grain
    real block_nm = 0.0f;            ///< thickness of a coherent block
    real block_factor = 1.0f;        ///< this stay's, on the mean thickness of blocks
    real own_excess = 1.0f;          ///< twins: see own_twin_excess
    uint64_t p_polarized = 0;        ///< a bit per family: how the light is polarized towards it
    real max_rate_per_mm = 0.0f;     ///< where rates saturate
    Quaternion object_from_lattice;  ///< with the tilt of this stay
    GrainRates<N> rates[2];          ///< along the present direction and along the one before
    int current = 0;                 ///< which of the two is the present one
    bool present_known = false;
    int link = -1;         ///< family that turns one into the other; -1: the other is not known
    real clear_mm = 0.0f;  ///< no surface lies nearer to where the present flight starts

    OPAL_HD const GrainRates<N>& present() const { return rates[current]; }
    /// The next flight starts a new stay: after scattering, or at the surface.
    OPAL_HD void renew() {
        fresh = true;
        clear_mm = 0.0f;
        at_boundary = false;
    }
    OPAL_HD void enter(int next_grain) {
        grain = next_grain;
        fresh = true;
        if (next_grain == 0) {
            clear_mm = 0.0f;
            cell = -1;
        }
        at_boundary = true;
    }
};

/// Triangular factor in [0.5, 1.5] on the mean thickness of a block: the spread of block sizes washes out fringes that no real
/// opal shows.
OPAL_HD inline real draw_block_factor(PathRandom& random) {
    return 0.5f + 0.5f * (random.next() + random.next());
}

/// Of the layers of a grain of n layers that starts in the lattice's own sense, the mean part by which those of that sense
/// outnumber the twin's: each layer keeps the sense but for a probability `fault`, so that after m layers the excess is exp(-2
/// fault m).
OPAL_HD inline real own_twin_excess(real fault, real layers) {
    const real x = 2.0f * fault * layers;
    return x > 1.0e-4f ? -expm1(-x) / x : 1.0f;
}

template <int N>
OPAL_HD inline void begin_visit(const OpalView& opal, GrainVisit<N>& visit, PathRandom& random) {
    const real size_mm = opal.grain_size_mm[visit.grain - 1] * opal.world_from_object.scale;
    visit.block_factor = draw_block_factor(random);
    visit.block_nm = min_of(visit.block_factor * opal.coherence_nm, size_mm * 1.0e6f);
    visit.own_excess = own_twin_excess(opal.fault, size_mm * 1.0e6f / opal.layer_nm);
    visit.p_polarized = (uint64_t(random.next_bits()) << 32) | random.next_bits();
    visit.max_rate_per_mm = opal.max_odds / size_mm;
    visit.object_from_lattice = opal.orientations[visit.grain - 1];
    if (opal.mosaic_kappa > 0.0f) {
        const real u1 = random.next(), u2 = random.next(), u3 = random.next(), u4 = random.next();
        visit.object_from_lattice = visit.object_from_lattice * sample_mosaic_tilt(opal.mosaic_kappa, u1, u2, u3, u4);
    }
    visit.fresh = false;
    visit.present_known = false;
    visit.link = -1;
}

/// Families as light of one direction and one stay meets them.
struct MetFamilies {
    real cosine[max_tested_pairs];     ///< |w . g|
    real polarized[max_tested_pairs];  ///< 1: p, in the plane of incidence; 0: s
};

/// Lists the families within an octave of their Bragg wavelength at one lane or another in `rates.pair`, in ascending order: no
/// other turns light.
template <int N>
OPAL_HD inline void list_near_families(const OpalView& opal, const LaneOptics<N>& optics, const GrainVisit<N>& visit,
                                       Vec3 lattice_direction, MetFamilies& met, GrainRates<N>& rates) {
    // Twice the cosine over g, times n / lambda, is the ratio of wavelengths, which has to lie between 1/2 and 2.
    real smallest = optics.n_eff[0] / optics.wavelength_nm[0], largest = smallest;
    for (int i = 1; i < N; ++i) {
        const real n_over_lambda = optics.n_eff[i] / optics.wavelength_nm[i];
        smallest = min_of(smallest, n_over_lambda);
        largest = max_of(largest, n_over_lambda);
    }
    // So that rounding decides nothing here.
    smallest *= 0.99999f;
    largest *= 1.00001f;
    const PlaneFamilies& families = opal.families;
    int count = 0;
    for (int first = 0; first < opal.num_pairs; first += beam_block_size) {
        const uint32_t bits = uint32_t(visit.p_polarized >> first);
        int near[beam_block_size];
        OPAL_SIMD
        for (int j = 0; j < beam_block_size; ++j) {
            const int k = first + j;
            const real cosine = fabs(lattice_direction.x * families.normal_x[k] + lattice_direction.y * families.normal_y[k] +
                                     lattice_direction.z * families.normal_z[k]);
            met.cosine[k] = cosine;
            met.polarized[k] = real((bits >> j) & 1u);
            near[j] = (4.0f * cosine * largest >= families.g_per_nm[k]) & (cosine * smallest <= families.g_per_nm[k]) &
                      (cosine >= 1.0e-4f) & (families.form[k] > 0.0f);
        }
        for (int j = 0; j < beam_block_size; ++j) {
            rates.pair[count] = first + j;
            count += near[j];
        }
    }
    rates.count = count;
}

/// A block of the listed families, from the one at place `first` on; places beyond the last are of no strength.
template <int N>
OPAL_HD inline BeamBlock beams_at(const OpalView& opal, const GrainVisit<N>& visit, const MetFamilies& met,
                                  const GrainRates<N>& rates, int first) {
    const PlaneFamilies& families = opal.families;
    BeamBlock beams;
    for (int j = 0; j < beam_block_size; ++j) {
        const int k = rates.pair[min_of(first + j, rates.count - 1)];
        beams.cosine[j] = met.cosine[k];
        beams.g_per_nm[j] = families.g_per_nm[k];
        beams.form[j] = first + j < rates.count ? families.form[k] : 0.0f;
        beams.polarized[j] = met.polarized[k];
        beams.block_nm[j] = visit.block_nm;
        beams.share[j] = 1.0f;
    }
    if (opal.fault == 0.0f) return beams;
    for (int j = 0; j < beam_block_size; ++j) {
        const int k = rates.pair[min_of(first + j, rates.count - 1)];
        beams.block_nm[j] = min_of(visit.block_nm, visit.block_factor * families.coherence_nm[k]);
        beams.share[j] = families.twin[k] == 0.0f ? 1.0f : 0.5f * (1.0f + families.twin[k] * visit.own_excess);
    }
    return beams;
}

/// Rates along `direction` (world; `lattice_direction` in the lattice's frame).
template <int N>
OPAL_HD inline void evaluate_rates(const OpalView& opal, const LaneOptics<N>& optics, const GrainVisit<N>& visit, Vec3 direction,
                                   Vec3 lattice_direction, GrainRates<N>& rates) {
    rates.count = 0;
    rates.direction = direction;
    for (int i = 0; i < N; ++i) rates.total_per_mm[i] = 0.0f;
    if (opal.diffraction == Diffraction::ewald_fresnel) return;  // turns at boundaries alone
    MetFamilies met;
    list_near_families(opal, optics, visit, lattice_direction, met, rates);
    if (rates.count == 0) return;
    real totals[N][beam_block_size] = {};
    for (int first = 0; first < rates.count; first += beam_block_size) {
        const BeamBlock beams = beams_at(opal, visit, met, rates, first);
        real block_rates[N][beam_block_size];
        if (opal.diffraction == Diffraction::laue)
            laue_rates(beams, optics, visit.max_rate_per_mm, block_rates);
        else
            reflection_rates(beams, optics, visit.max_rate_per_mm, block_rates);
        for (int i = 0; i < N; ++i) {
            OPAL_SIMD
            for (int j = 0; j < beam_block_size; ++j) {
                rates.rate_per_mm[i][first + j] = block_rates[i][j];
                totals[i][j] += block_rates[i][j];
            }
        }
    }
    for (int i = 0; i < N; ++i)
        for (int j = 0; j < beam_block_size; ++j) rates.total_per_mm[i] += totals[i][j];
}

/// Which family turns the hero, given that one does and that it is not family `other` (-1: any): by its rate; `rest` is drawn
/// uniformly in [0, the sum of their rates). Returns an index into the rates; -1 if there is no such family.
template <int N>
OPAL_HD inline int choose_family(const GrainRates<N>& rates, real rest, int other = -1) {
    int chosen = -1;
    for (int i = 0; i < rates.count; ++i) {
        const real rate = rates.rate_per_mm[0][i];
        if (i == other || !(rate > 0.0f)) continue;
        chosen = i;  // rounding can carry `rest` past the last family; never onto one that does not turn
        if (rest < rate) break;
        rest -= rate;
    }
    return chosen;
}

/// Turns the visit's present direction by family `k`: back to the direction before if that family led here, else into a new one.
/// Returns the new direction (world).
template <int N>
OPAL_HD inline Vec3 turn_visit(const OpalView& opal, GrainVisit<N>& visit, int k) {
    if (k == visit.link) {
        visit.current = 1 - visit.current;
        return visit.present().direction;
    }
    const Vec3 normal = opal.world_from_object.world_from_local_direction(visit.object_from_lattice.rotate(opal.pairs[k].normal));
    const Vec3 turned = normalize(mirror(visit.present().direction, normal));
    visit.current = 1 - visit.current;
    visit.present_known = false;
    visit.link = k;
    return turned;
}

}  // namespace opal
