// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace opal {

/// Renders examples/media_checks (found in `scenes`) under uniform light and under a bright disc on a dark surround, each twice
/// with different seeds, and writes folder/media_checks.csv: samples per second of the whole picture; and over the pixels wholly
/// inside the ball's outline the mean of Y with its standard error, the variance of one sample (half the mean squared difference
/// of the two pictures, times the samples per pixel) and its product with the time per sample. folder/disc.exr is the uneven
/// light, for other renderers to be run beside.
void bench_media_checks(const std::filesystem::path& scenes, const std::filesystem::path& folder, int samples);

}  // namespace opal
