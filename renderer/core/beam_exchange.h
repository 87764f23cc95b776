// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/exchange_region.h"
#include "renderer/core/exponential.h"
#include "renderer/core/grain_visit.h"

namespace opal {

/// A flight whose end is drawn: its length and the family that turns the light there.
struct PlannedTurn {
    real length_mm = 0.0f;  ///< world
    int family = -1;        ///< index into the present rates; -1: nothing is drawn yet
};

/// Light inside a band goes back and forth between two beams many times before it gets anywhere. As long as it stays where
/// neither the grain nor the body ends, nothing has to be looked up: this is the same random walk as flight by flight, with what
/// the lanes' weights become gathered over it.
struct BeamExchange {
    real flown_mm[2] = {0.0f, 0.0f};  ///< along each of the visit's two directions, world
    real turns[2] = {0.0f, 0.0f};     ///< by the pair, out of each
    int turned_by = -1;      ///< family other than the pair's that turned the light in the end; index into the present rates
    bool scattered = false;  ///< at the end of it
    PlannedTurn next;        ///< else the next flight, which may leave

    OPAL_HD real path_mm() const { return flown_mm[0] + flown_mm[1]; }
};

/// Index of a pair of planes among the rates; -1 where it does not turn the hero.
template <int N>
OPAL_HD inline int find_family(const GrainRates<N>& rates, int pair) {
    for (int i = 0; i < rates.count; ++i)
        if (rates.pair[i] == pair && rates.rate_per_mm[0][i] > 0.0f) return i;
    return -1;
}

/// Rates above which going back and forth is worth the looking around before it.
inline constexpr real exchange_min_rate_per_mm = 30.0f;

/// Whether the light of a visit is likely to be turned back and forth: both directions are known and turn into each other.
template <int N>
OPAL_HD inline bool exchanges_beams(const GrainVisit<N>& visit) {
    return visit.link >= 0 && visit.present_known && visit.present().total_per_mm[0] > exchange_min_rate_per_mm;
}

/// Walks from the present direction until a flight might leave the region, another family turns the light, or it has flown
/// `scatter_mm`. The visit's present direction is then that of the last flight, or of the next one. `region_per_mm`: the region's
/// millimetres in one of the world.
template <int N>
OPAL_HD inline BeamExchange exchange_beams(GrainVisit<N>& visit, const ExchangeRegion& region, real region_per_mm,
                                           real scatter_mm, PathRandom& random) {
    BeamExchange exchange;
    int family[2];
    real mean_mm[2], other_per_mm[2];  // to a turn by the pair, of turns by others
    for (int d = 0; d < 2; ++d) {
        const GrainRates<N>& rates = visit.rates[d];
        family[d] = find_family(rates, visit.link);
        const real back_per_mm = family[d] >= 0 ? rates.rate_per_mm[0][family[d]] : 0.0f;
        mean_mm[d] = back_per_mm > 0.0f ? 1.0f / back_per_mm : 3.0e30f;
        other_per_mm[d] = max_of(0.0f, rates.total_per_mm[0] - back_per_mm);
    }
    // What is left until each of them, wherever the light flies meanwhile.
    real other_depth = free_depth(random.next());
    const int first = visit.current;
    while (true) {
        const int d = visit.current;
        PlannedTurn turn{free_depth(random.next()) * mean_mm[d], family[d]};
        if (other_depth < turn.length_mm * other_per_mm[d]) {
            turn.length_mm = other_depth / other_per_mm[d];
            turn.family = choose_family(visit.rates[d], random.next() * other_per_mm[d], family[d]);
            // Rounding alone may leave nobody else: then it was the pair.
            if (turn.family < 0) turn.family = family[d];
        }
        const real length_mm = min_of(turn.length_mm, scatter_mm);
        const real end_mm = region_per_mm * (exchange.flown_mm[d] + length_mm);
        const real across_mm = region_per_mm * exchange.flown_mm[1 - d];
        if (!region.holds(d == first ? end_mm : across_mm, d == first ? across_mm : end_mm)) {
            exchange.next = turn;
            return exchange;
        }
        exchange.flown_mm[d] += length_mm;
        if (turn.length_mm >= scatter_mm) {
            exchange.scattered = true;
            return exchange;
        }
        if (turn.family != family[d]) {
            exchange.turned_by = turn.family;
            return exchange;
        }
        scatter_mm -= length_mm;
        other_depth -= length_mm * other_per_mm[d];
        exchange.turns[d] += 1.0f;
        visit.current = 1 - d;
    }
}

/// Every lane's probability of what happened between the two beams, over the hero's.
template <int N>
OPAL_HD inline void weigh_exchange(const GrainVisit<N>& visit, const BeamExchange& exchange, LaneWeights<N>& weights) {
    real logarithms[N] = {};
    for (int d = 0; d < 2; ++d) {
        const GrainRates<N>& rates = visit.rates[d];
        // Flights and turns apart may be beyond a float's range where together they are not.
        OPAL_SIMD
        for (int i = 0; i < N; ++i) logarithms[i] += (rates.total_per_mm[0] - rates.total_per_mm[i]) * exchange.flown_mm[d];
        if (exchange.turns[d] == 0.0f) continue;
        const int family = find_family(rates, visit.link);
        const real hero_per_mm = rates.rate_per_mm[0][family];
        OPAL_SIMD
        for (int i = 0; i < N; ++i) {
            const real ratio = rates.rate_per_mm[i][family] / hero_per_mm;
            logarithms[i] += ratio > 1.0e-37f ? exchange.turns[d] * logarithm(ratio) : -1.0e30f;
        }
    }
    OPAL_SIMD
    for (int i = 1; i < N; ++i) weights.ratio.v[i] *= exponential(logarithms[i]);
}

}  // namespace opal
