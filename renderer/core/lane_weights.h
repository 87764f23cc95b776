// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/spectrum_view.h"

namespace opal {

/// What a path carries per wavelength. All decisions are made for the hero; `ratio` is the probability with which each lane would
/// have made the same decisions, over the hero's. Weighting by the balance heuristic over the lanes (Wilkie et al. 2014) then
/// makes every lane's estimate unbiased, and lanes drop out as their own probability of the path vanishes.
struct LaneWeights {
    Lanes throughput = Lanes::all(1.0f);  ///< physical throughput over the lane's own path probability
    Lanes ratio = Lanes::all(1.0f);       ///< path probability of the lane over the hero's; lane 0 stays 1
    int count = num_lanes;

    /// Weight of each lane's contribution; an average over the lanes in use gives the estimate.
    OPAL_HD Lanes contribution() const {
        float sum = 0.0f;
        for (int i = 0; i < count; ++i) sum += ratio.v[i];
        Lanes weights;
        for (int i = 0; i < count; ++i) weights.v[i] = throughput.v[i] * ratio.v[i] * (float(count) / sum);
        return weights;
    }
};

}  // namespace opal
