// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/finite_pixels.h"

#include <fmt/format.h>

#include <cmath>

namespace opal {
namespace {

/// Indices of those of R, G and B that the picture has.
std::vector<int> color_channels(const Image& image) {
    std::vector<int> channels;
    for (const char* name : {"R", "G", "B"})
        if (const int channel = image.find_channel(name); channel >= 0) channels.push_back(channel);
    return channels;
}

bool is_broken(const float* pixel, const std::vector<int>& channels) {
    for (const int channel : channels)
        if (!std::isfinite(pixel[channel])) return true;
    return false;
}

}  // namespace

std::optional<BrokenPixels> find_broken_pixels(const Image& image) {
    const std::vector<int> channels = color_channels(image);
    BrokenPixels broken;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (is_broken(image.pixel(x, y), channels) && broken.count++ == 0) {
                broken.x = image.x0 + x;
                broken.y = image.y0 + y;
            }
    return broken.count > 0 ? std::optional(broken) : std::nullopt;
}

std::string describe(const BrokenPixels& broken, const std::string& file) {
    return broken.count == 1 ? fmt::format("{}: pixel ({}, {}) is not a finite number", file, broken.x, broken.y)
                             : fmt::format("{}: {} pixels are not finite numbers, the first at ({}, {})", file, broken.count,
                                           broken.x, broken.y);
}

void blacken_broken_pixels(Image& image) {
    const std::vector<int> channels = color_channels(image);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            float* const pixel = image.pixel(x, y);
            if (!is_broken(pixel, channels)) continue;
            for (const int channel : channels) pixel[channel] = 0.0f;
        }
}

}  // namespace opal
