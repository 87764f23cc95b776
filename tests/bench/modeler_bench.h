// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace opal {

/// One measured figure.
struct BenchRow {
    std::string what;
    double value = 0.0;
    std::string unit;
};

/// Speed and memory of opal-model, as ratios within this run: labelling against a k-d tree per voxel, builds of 27,000 and
/// 262,144 sites, growth with the resolution, one thread against two, peak memory against the grids written, sites alone.
/// `quick` takes an eighth of the voxels. Files in between go into `folder`. Throws SystemError where a build fails.
std::vector<BenchRow> bench_modeler(const std::filesystem::path& folder, bool quick);

}  // namespace opal
