// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/render_warnings.h"

#include <fmt/format.h>

namespace opal {
namespace {

/// From here on the missing light shows: the body of a milky opal turns dark and reddish.
constexpr double many_truncated = 0.01;
/// Gaps between triangles lose a path in a hundred thousand.
constexpr double many_lost = 0.001;
/// Of the stays in grains: then about a fifth of the reflected light meets two strong families at once (docs/stability.md).
constexpr double many_multi_beam = 0.03;

}  // namespace

std::vector<std::string> render_warnings(const PathCounters& counters, std::uint64_t samples, int max_bounces) {
    std::vector<std::string> warnings;
    const double paths = double(samples);
    if (double(counters.truncated_paths) > many_truncated * paths)
        warnings.push_back(fmt::format("{:.1f} % of the paths were cut off after {} bounces; raise render.max_bounces",
                                       100.0 * double(counters.truncated_paths) / paths, max_bounces));
    if (double(counters.lost_paths) > many_lost * paths)
        warnings.push_back(
            fmt::format("{:.2g} % of the paths left a body through gaps of its surface and count as black; are places "
                        "far from the origin, or bodies thinner than a voxel?",
                        100.0 * double(counters.lost_paths) / paths));
    const double stays = double(counters.grain_crossings);
    if (double(counters.multi_beam_stays) > many_multi_beam * stays)
        warnings.push_back(
            fmt::format("{:.1f} % of the stays in grains begin near two strong reflections at once, of which two-beam theory "
                        "reflects up to 15 % too little; smaller spheres meet fewer",
                        100.0 * double(counters.multi_beam_stays) / stays));
    if (counters.majorant_violations > 0)
        warnings.push_back(
            fmt::format("{} collisions met a field above its majorant; please report the scene", counters.majorant_violations));
    if (counters.not_a_number > 0)
        warnings.push_back(
            fmt::format("{} samples were not numbers and count as black; please report the scene", counters.not_a_number));
    return warnings;
}

}  // namespace opal
