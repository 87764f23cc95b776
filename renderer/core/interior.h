// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/lane_weights.h"
#include "renderer/core/path_random.h"
#include "renderer/core/phase.h"
#include "renderer/core/scene_view.h"
#include "renderer/core/two_beam.h"

/// Transport inside the opal: grains met one after another, each a chance to diffract; scattering and absorption on the way.
namespace opal {

/// Counts that a render reports.
struct PathCounters {
    uint64_t diffractions = 0;
    uint64_t scatterings = 0;
    uint64_t grain_crossings = 0;
    uint64_t renormalized_crossings = 0;  ///< several strong families at once: probabilities scaled to sum to 1
    uint64_t lost_paths = 0;              ///< left the opal through a gap of its surface
    uint64_t truncated_paths = 0;
    uint64_t not_a_number = 0;
};

/// Coefficients of the opal's body for the lanes of a path, per mm.
struct LaneMedium {
    Lanes sigma_a, sigma_rayleigh, sigma_mie;

    OPAL_HD float sigma_s(int lane) const { return sigma_rayleigh.v[lane] + sigma_mie.v[lane]; }
};

OPAL_HD inline LaneMedium lane_medium(const OpalView& opal, const PathWavelengths& wavelengths) {
    LaneMedium medium;
    for (int i = 0; i < wavelengths.count; ++i) {
        const float relative = 400.0f / wavelengths.wavelength_nm[i];
        medium.sigma_a.v[i] = table_at(opal.sigma_a_per_mm, wavelengths.wavelength_nm[i]);
        medium.sigma_rayleigh.v[i] = opal.sigma_s_rayleigh_400nm_per_mm * square(square(relative));
        medium.sigma_mie.v[i] = opal.sigma_s_mie_per_mm;
    }
    return medium;
}

/// Where inside the opal a path is.
struct InteriorState {
    int grain = 0;              ///< 0: not known yet
    uint64_t tested_pairs = 0;  ///< families that already turned the path in this grain: the pile's formula holds their ping-pong
};

enum class InteriorEventKind { surface, diffraction, scattering };

struct InteriorEvent {
    InteriorEventKind kind = InteriorEventKind::surface;
    float distance_mm = 0.0f;
    Vec3 direction;
};

/// Reflection odds of every family of planes along one stretch of one grain.
struct GrainOdds {
    PileOdds odds[max_tested_pairs];
    int pair[max_tested_pairs];
    int count = 0;
    Lanes scale = Lanes::all(1.0f);  ///< below 1 where the reflectances would sum to more than 1
    Lanes total;                     ///< probability of turning anywhere on the stretch

    /// Probability of passing a fraction of the stretch without turning.
    OPAL_HD float passed(int lane, float fraction) const {
        float sum = 0.0f;
        for (int i = 0; i < count; ++i) sum += odds[i].reflectance(lane, fraction);
        return max_of(0.0f, 1.0f - scale.v[lane] * sum);
    }
};

/// Mean thickness times a triangular factor in [0.5, 1.5]: the spread of block sizes washes out fringes that no real opal shows.
OPAL_HD inline float draw_coherence_nm(float mean_nm, PathRandom& random) {
    return mean_nm * (0.5f + 0.5f * (random.next() + random.next()));
}

OPAL_HD inline void evaluate_grain(const OpalView& opal, const PathWavelengths& wavelengths, Vec3 lattice_direction,
                                   float chord_nm, float coherence_nm, uint64_t tested_pairs, GrainOdds& result) {
    result.count = 0;
    float reflected[PileOdds::size] = {};
    for (int k = 0; k < opal.num_pairs; ++k) {
        const PlanePair& pair = opal.pairs[k];
        const float cosine = fabsf(dot(lattice_direction, pair.normal));
        if (((tested_pairs >> k) & 1u) != 0 || cosine < 1.0e-4f) continue;
        BeamGeometry beam{cosine, pair.g_per_nm, pair.epsilon, opal.n_eff, 0.0f, 1.0f};
        set_blocks(beam, chord_nm, coherence_nm);
        PileOdds& pile = result.odds[result.count];
        if (!pile_odds(beam, wavelengths.wavelength_nm, pile)) continue;
        OPAL_SIMD
        for (int i = 0; i < PileOdds::size; ++i) reflected[i] += pile.odds[i] / (1.0f + pile.odds[i]);
        result.pair[result.count++] = k;
    }
    for (int i = 0; i < num_lanes; ++i) result.total.v[i] = 0.5f * (reflected[i] + reflected[num_lanes + i]);
    for (int i = 0; i < wavelengths.count; ++i) {
        result.scale.v[i] = result.total.v[i] > 1.0f ? 1.0f / result.total.v[i] : 1.0f;
        result.total.v[i] = min_of(result.total.v[i], 1.0f);
    }
}

/// Where on a stretch the hero turns: which family, and at which fraction of the way.
struct Turn {
    int index = -1;  ///< into GrainOdds; -1: it does not
    float fraction = 1.0f;
};

/// Draws the hero's turn with probability `total`: family by reflectance, polarization by its share, depth by inverting
/// R(x) = N x / (1 + N x).
OPAL_HD inline Turn draw_turn(const GrainOdds& grain, PathRandom& random) {
    float u = random.next();
    if (u >= grain.total.v[0]) return {};
    u /= grain.scale.v[0];
    Turn turn;
    for (int i = 0; i < grain.count; ++i) {
        const float reflectance = grain.odds[i].reflectance(0);
        if (reflectance > 0.0f)
            turn.index = i;  // rounding can carry u past the last family; never onto one that does not reflect
        if (u < reflectance) break;
        u -= reflectance;
    }
    const float s = grain.odds[turn.index].s(0), p = grain.odds[turn.index].p(0);
    const float reflectance_s = s / (1.0f + s), reflectance_p = p / (1.0f + p);
    const float n = random.next() * (reflectance_s + reflectance_p) < reflectance_s ? s : p;
    const float reached = random.next() * n / (1.0f + n);
    turn.fraction = n > 0.0f ? min_of(1.0f, reached / ((1.0f - reached) * n)) : 1.0f;
    return turn;
}

/// Absorption to the path's throughput, and the lanes' probability of not scattering on the way, over `distance_mm`.
OPAL_HD inline void attenuate(const LaneMedium& medium, float distance_mm, LaneWeights& weights) {
    for (int i = 0; i < weights.count; ++i) {
        weights.throughput.v[i] *= expf(-medium.sigma_a.v[i] * distance_mm);
        if (i > 0) weights.ratio.v[i] *= expf((medium.sigma_s(0) - medium.sigma_s(i)) * distance_mm);
    }
}

OPAL_HD inline Vec3 scatter_direction(const OpalView& opal, const LaneMedium& medium, Vec3 direction, LaneWeights& weights,
                                      PathRandom& random) {
    const bool rayleigh = random.next() * medium.sigma_s(0) < medium.sigma_rayleigh.v[0];
    const Lanes& chosen = rayleigh ? medium.sigma_rayleigh : medium.sigma_mie;
    for (int i = 1; i < weights.count; ++i) weights.ratio.v[i] *= chosen.v[i] / chosen.v[0];
    const float u = random.next();
    const float cosine = rayleigh ? sample_rayleigh_cosine(u) : sample_henyey_greenstein_cosine(u, opal.mie_asymmetry);
    return deflect(direction, cosine, random.next());
}

/// Follows `ray` (world, inside the opal) until it turns, scatters or reaches the surface `surface_mm` ahead.
OPAL_HD inline InteriorEvent cross_interior(const OpalView& opal, const PathWavelengths& wavelengths, const LaneMedium& medium,
                                            Ray ray, float surface_mm, InteriorState& state, LaneWeights& weights,
                                            PathRandom& random, PathCounters& counters) {
    const float sigma_s = medium.sigma_s(0);
    const float scatter_mm = sigma_s > 0.0f ? -logf(1.0f - random.next()) / sigma_s : 3.0e38f;
    const float end_mm = min_of(surface_mm, scatter_mm);
    InteriorEvent event{scatter_mm < surface_mm ? InteriorEventKind::scattering : InteriorEventKind::surface, end_mm,
                        ray.direction};

    if (opal.diffraction && opal.num_pairs > 0) {
        const float scale = opal.world_from_object.scale;
        const Vec3 direction = opal.world_from_object.local_from_world_direction(ray.direction);
        GrainWalk walk(opal.grains, opal.world_from_object.local_from_world_point(ray.origin), direction);
        GrainOdds grain;
        float reached = 0.0f;  // object mm, like everything on the walk
        float entered = 0.0f;
        if (state.grain == 0) state.grain = walk.next_grain(0, reached, surface_mm / scale);
        while (state.grain != 0) {
            const int next = walk.next_grain(state.grain, reached, surface_mm / scale);
            const float chord_mm = (reached - entered) * scale;
            if (chord_mm > 0.0f) {
                ++counters.grain_crossings;
                const Quaternion orientation = opal.orientations[state.grain - 1];
                const Vec3 lattice_direction = orientation.conjugate().rotate(direction);
                evaluate_grain(opal, wavelengths, lattice_direction, chord_mm * 1.0e6f,
                               draw_coherence_nm(opal.coherence_nm, random), state.tested_pairs, grain);
                if (grain.scale.v[0] < 1.0f) ++counters.renormalized_crossings;
                const Turn turn = draw_turn(grain, random);
                const float turn_mm = turn.index >= 0 ? entered * scale + turn.fraction * chord_mm : 3.0e38f;
                if (turn_mm < end_mm) {
                    const PileOdds& odds = grain.odds[turn.index];
                    const float hero = grain.scale.v[0] * odds.turning_density(0, turn.fraction);
                    for (int i = 1; i < weights.count; ++i)
                        weights.ratio.v[i] *= grain.scale.v[i] * odds.turning_density(i, turn.fraction) / hero;
                    const int k = grain.pair[turn.index];
                    const Vec3 normal =
                        opal.world_from_object.world_from_local_direction(orientation.rotate(opal.pairs[k].normal));
                    state.tested_pairs |= uint64_t(1) << k;
                    ++counters.diffractions;
                    attenuate(medium, turn_mm, weights);
                    return {InteriorEventKind::diffraction, turn_mm, normalize(mirror(ray.direction, normal))};
                }
                const float fraction = min_of(1.0f, (end_mm - entered * scale) / chord_mm);
                // Rounding can let a hero pass whose probability of it rounds to 0; its companions then pass like it.
                const float hero = grain.passed(0, fraction);
                for (int i = 1; i < weights.count && hero > 0.0f; ++i) weights.ratio.v[i] *= grain.passed(i, fraction) / hero;
            }
            if (next == 0 || reached * scale >= end_mm) break;
            state.grain = next;
            state.tested_pairs = 0;
            entered = reached;
        }
    }
    attenuate(medium, end_mm, weights);
    if (event.kind == InteriorEventKind::scattering) {
        ++counters.scatterings;
        event.direction = scatter_direction(opal, medium, ray.direction, weights, random);
        state.tested_pairs = 0;
    }
    return event;
}

}  // namespace opal
