// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/grain_visit.h"

namespace opal {

/// Light inside a band goes back and forth between two beams many times before it gets anywhere. As long as it stays in a ball
/// within which neither the grain nor the body ends, nothing has to be looked up: this is the same random walk as flight by
/// flight, with what the lanes' weights become gathered over it.
template <int N>
struct BeamExchange {
    Vec3 offset;           ///< from where it began, world mm
    float path_mm = 0.0f;  ///< flown in all
    uint64_t turns = 0;
    int turned_by = -1;      ///< family other than the pair's that turned the light in the end; index into the present rates
    bool scattered = false;  ///< at the end of `path_mm`
};

/// Index of a pair of planes among the rates; -1 where it does not turn the hero.
template <int N>
OPAL_HD inline int find_family(const GrainRates<N>& rates, int pair) {
    for (int i = 0; i < rates.count; ++i)
        if (rates.pair[i] == pair && rates.rate_per_mm[i][0] > 0.0f) return i;
    return -1;
}

/// Rates above which going back and forth is worth the looking around before it.
inline constexpr float exchange_min_rate_per_mm = 30.0f;

/// Whether the light of a visit is likely to be turned back and forth: both directions are known and turn into each other.
template <int N>
OPAL_HD inline bool exchanges_beams(const GrainVisit<N>& visit) {
    return visit.link >= 0 && visit.present_known && visit.present().total_per_mm[0] > exchange_min_rate_per_mm;
}

/// Walks from the present direction until the light leaves the ball of radius `clear_mm`, is turned by another family, or has
/// flown `scatter_mm`. The visit's present direction is then that of the last flight.
template <int N>
OPAL_HD inline BeamExchange<N> exchange_beams(GrainVisit<N>& visit, float clear_mm, float scatter_mm, LaneWeights<N>& weights,
                                              PathRandom& random) {
    BeamExchange<N> exchange;
    const int family[2] = {find_family(visit.rates[0], visit.link), find_family(visit.rates[1], visit.link)};
    float flown_mm[2] = {0.0f, 0.0f};  // along each of the two directions
    float turns[2] = {0.0f, 0.0f};
    while (true) {
        const int current = visit.current;
        const GrainRates<N>& rates = visit.rates[current];
        const Vec3 direction = rates.direction;
        const float along = dot(exchange.offset, direction);
        const float inside = clear_mm * clear_mm - dot(exchange.offset, exchange.offset);
        const float leaves_mm = max_of(0.0f, sqrtf(max_of(0.0f, along * along + inside)) - along);
        const float turn_mm = -logf(1.0f - random.next()) / rates.total_per_mm[0];
        const float end_mm = min_of(leaves_mm, scatter_mm - exchange.path_mm);
        const float flight_mm = min_of(turn_mm, end_mm);
        flown_mm[current] += flight_mm;
        exchange.path_mm += flight_mm;
        exchange.offset = exchange.offset + flight_mm * direction;
        if (turn_mm >= end_mm) {
            exchange.scattered = end_mm < leaves_mm;
            break;
        }
        ++exchange.turns;
        const float u = random.next() * rates.total_per_mm[0];
        const float back = family[current] >= 0 ? rates.rate_per_mm[family[current]][0] : 0.0f;
        if (u >= back) {
            exchange.turned_by = choose_family(rates, u - back, family[current]);
            // Rounding alone may leave nobody else: then it was the pair.
            if (exchange.turned_by >= 0) break;
        }
        turns[current] += 1.0f;
        visit.current = 1 - current;
    }
    for (int i = 1; i < weights.count; ++i) {
        // Flights and turns apart may be beyond a float's range where together they are not.
        float logarithm = 0.0f;
        for (int d = 0; d < 2; ++d) {
            const GrainRates<N>& rates = visit.rates[d];
            logarithm += (rates.total_per_mm[0] - rates.total_per_mm[i]) * flown_mm[d];
            if (turns[d] == 0.0f) continue;
            const float* rate_per_mm = rates.rate_per_mm[family[d]];
            logarithm += rate_per_mm[i] > 0.0f ? turns[d] * logf(rate_per_mm[i] / rate_per_mm[0]) : -3.0e38f;
        }
        weights.ratio.v[i] *= expf(logarithm);
    }
    return exchange;
}

}  // namespace opal
