// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/spectrum_view.h"

namespace opal {

/// What a path carries per wavelength. All decisions are made for the hero; `ratio` is the probability with which each lane would
/// have made the same decisions, over the hero's. Weighting by the balance heuristic over the lanes (Wilkie et al. 2014) then
/// makes every lane's estimate unbiased, and lanes drop out as their own probability of the path vanishes. A ratio has the mean 1
/// over all paths, so that one beyond the range of a float is no concern (Markov's inequality).
template <int N>
struct LaneWeights {
    Lanes<N> throughput = Lanes<N>::all(1.0f);  ///< physical throughput over the lane's own path probability
    Lanes<N> ratio = Lanes<N>::all(1.0f);       ///< path probability of the lane over the hero's; lane 0 stays 1
    int count = N;
    int guided_scatterings = 0;  ///< directions drawn with the help of a guide so far

    /// Weight of each lane's contribution; an average over the lanes in use gives the estimate.
    OPAL_HD Lanes<N> contribution() const {
        real sum = 0.0f;
        for (int i = 0; i < count; ++i) sum += ratio.v[i];
        Lanes<N> weights;
        for (int i = 0; i < count; ++i) weights.v[i] = throughput.v[i] * ratio.v[i] * (real(count) / sum);
        return weights;
    }

    /// After a choice that no companion could have shared: only the hero goes on.
    OPAL_HD void drop_companions() {
        for (int i = 1; i < count; ++i) ratio.v[i] = 0.0f;
    }
};

}  // namespace opal
