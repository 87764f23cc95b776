// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>

namespace opal {

/// Writes folder/bvh.csv: the hierarchy for devices against Embree on the CPU, `rays` rays over all scenes: agreement, and the
/// time of a ray.
void bench_bvh(const std::filesystem::path& folder, std::uint64_t rays);

}  // namespace opal
