// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "renderer/core/path_launch.h"
#include "renderer/host/film.h"

namespace opal {

/// Time that a device spent on kinds of work, by its own clock.
struct KernelSeconds {
    double trace = 0.0;  ///< following paths
    double add = 0.0;    ///< adding what they found to the film
};

/// A machine that draws samples in place of the processor's cores.
class PathDevice {
  public:
    virtual ~PathDevice() = default;

    /// As people know it; several where several work together.
    virtual std::vector<std::string> names() const = 0;
    /// Since it was made; nothing where the device has no clock of its own.
    virtual std::optional<KernelSeconds> kernel_seconds() const = 0;
    /// Draws the next `samples` samples of every pixel of some of the film's blocks, all at the same sample, and adds them to the
    /// film and to the blocks' totals and counters. Locks the blocks while it writes to them. Throws SystemError.
    virtual void advance(Film& film, std::span<const int> blocks, std::uint32_t samples) = 0;
};

/// The blocks as a launch needs them.
std::vector<LaunchBlock> launch_blocks(const Film& film, std::span<const int> blocks);
/// What the blocks' totals are so far.
std::vector<LaunchTotals> launch_totals(const Film& film, std::span<const int> blocks);
/// Moves a block on by `samples`: its totals become `totals`, `counters` are added.
void finish_block(FilmBlock& block, std::uint32_t samples, int pixels, const LaunchTotals& totals, const PathCounters& counters);

}  // namespace opal
