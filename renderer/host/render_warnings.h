// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/core/interior.h"

namespace opal {

/// What a user should know of a render's paths: many cut off or lost, many near two strong
/// reflections at once, bounds that were none, numbers that were none.
std::vector<std::string> render_warnings(const PathCounters& counters, std::uint64_t samples, int max_bounces);

}  // namespace opal
