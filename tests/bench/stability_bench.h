// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace opal {

/// Measures where each method degrades and writes stability.csv into `folder`, and its chart where Python has matplotlib.
/// `quick`: fewer samples and places.
void bench_stability(const std::filesystem::path& folder, bool quick);

}  // namespace opal
