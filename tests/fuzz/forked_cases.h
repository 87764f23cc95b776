// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "fuzz_case.h"

namespace opal::fuzz {

struct FuzzOptions {
    Lane lane = Lane::scenes;
    std::optional<Kind> only;  ///< of the lane's kinds
    std::uint64_t seed = 1, first = 0, cases = 1000;
    double cpu_limit_s = 20.0;     ///< of one case; ten times as much by the clock
    double memory_limit_gb = 4.0;  ///< address space of a process that runs cases
    std::filesystem::path keep;    ///< where the files of a case that went wrong are kept
};

struct FuzzSummary {
    std::uint64_t run = 0, results = 0, refused = 0, defects = 0;
};

/// Runs cases in processes of their own, some hundred in each, so that what kills one is told with its number and the next goes
/// on. Prints each defect and a summary per kind, with the heap that a case left occupied.
FuzzSummary run_forked(const FuzzOptions& options);

}  // namespace opal::fuzz
