// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/path_device.h"

namespace opal {

std::vector<LaunchBlock> launch_blocks(const Film& film, std::span<const int> blocks) {
    std::vector<LaunchBlock> result;
    for (const int index : blocks) {
        const PixelWindow window = film.block_window(index);
        result.push_back({window.x0, window.y0, window.x1, window.y1, film.block(index).end_sample});
    }
    return result;
}

std::vector<LaunchTotals> launch_totals(const Film& film, std::span<const int> blocks) {
    std::vector<LaunchTotals> result;
    for (const int index : blocks) {
        const SpectrumTotals& totals = film.block(index).totals;
        LaunchTotals& sums = result.emplace_back();
        for (int bin = 0; bin < num_bins; ++bin) sums.bin[bin] = totals.of_bin(bin);
        for (int c = 0; c < 3; ++c) sums.truncated_rgb[c] = totals.truncated_rgb[c];
    }
    return result;
}

void finish_block(FilmBlock& block, std::uint32_t samples, int pixels, const LaunchTotals& totals, const PathCounters& counters) {
    for (int bin = 0; bin < num_bins; ++bin) block.totals.set(bin, totals.bin[bin]);
    for (int c = 0; c < 3; ++c) block.totals.truncated_rgb[c] = totals.truncated_rgb[c];
    block.totals.samples += std::uint64_t(samples) * std::uint64_t(pixels);
    block.counters.add(counters);
    block.end_sample += samples;
}

}  // namespace opal
