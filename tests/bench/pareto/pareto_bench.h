// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace opal {

/// Every choice that trades speed for accuracy, one at a time, on the black, the white and the fire opal of the examples and on a
/// test block: processor time per sample, memory, and the error of the gem against the most exact value of that choice: bias, of
/// patches as large as a grain, apart from the noise of pixels. Writes folder/pareto.csv. Quick: two of the scenes, fewer values,
/// coarser statistics. `only`: names of choices or scenes, where not all are wanted.
///
/// Pictures are 40 x 30 pixels; every variant draws the same numbers with the same eight seeds, so that what two variants have in
/// common is noise in common.
void bench_pareto(const std::filesystem::path& folder, bool quick, const std::vector<std::string>& only = {});

}  // namespace opal
