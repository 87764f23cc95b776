// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace opal {

/// Measures cost against size and writes scaling.csv, the fitted exponents in scaling_fits.csv, and a chart where Python has
/// matplotlib. Costs are processor time of all threads together, but where it says otherwise. `quick`: small sizes alone.
void bench_scaling(const std::filesystem::path& folder, bool quick);

}  // namespace opal
