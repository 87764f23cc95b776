// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "formats/opal_asset.h"
#include "renderer/core/vec.h"

namespace opal {

/// A part of a ray in one grain, up to where the next begins.
struct GrainStretch {
    int grain;
    double begin_mm;
};

/// The grains along a ray through an additively weighted tessellation, in long double and by a way of its own: intervals of the
/// ray are halved until, by bounds on how fast delta can change, one grain is left in each; what is left at a boundary is
/// shorter than 1e-9 mm. All sites but those of grain 0 take part. Slow.
std::vector<GrainStretch> exact_stretches(const std::vector<Site>& sites, Vec3 origin, Vec3 direction, double end_mm);

/// How much farther, in the sense of delta, the nearest site of `grain` is than the nearest of all at a place of a ray (mm).
double excess_mm(const std::vector<Site>& sites, Vec3 origin, Vec3 direction, double at_mm, int grain);

/// The grains that a walk (GrainWalk, CellWalk, ...) finds.
template <class Walk>
std::vector<GrainStretch> walked_stretches(Walk&& walk, real end_mm) {
    std::vector<GrainStretch> stretches;
    real distance = 0.0f;
    int grain = 0;
    while ((grain = walk.next_grain(grain, distance, end_mm)) != 0) stretches.push_back({grain, double(distance)});
    return stretches;
}

/// What a walk got wrong, summed over rays.
struct WalkErrors {
    std::uint64_t crossings = 0;  ///< changes of grain along the rays
    std::uint64_t missed = 0;     ///< without a counterpart in the walk: between the same grains, within `match_mm`
    std::uint64_t spurious = 0;   ///< found by the walk without such a counterpart
    double length_mm = 0.0;
    double wrong_mm = 0.0;           ///< of it in the wrong grain
    double largest_excess_mm = 0.0;  ///< excess_mm in the middle of any stretch in the wrong grain
    double largest_error_mm = 0.0;   ///< of the distance of a crossing that has its counterpart
    double error_sum_mm = 0.0;
};

/// Compares what a walk found along a ray with the exact stretches.
void add_errors(const std::vector<Site>& sites, Vec3 origin, Vec3 direction, double end_mm,
                const std::vector<GrainStretch>& exact, const std::vector<GrainStretch>& walked, double match_mm,
                WalkErrors& errors);

}  // namespace opal
