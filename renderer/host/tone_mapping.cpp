// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/tone_mapping.h"

#include <algorithm>
#include <cmath>

#include "formats/colorimetry.h"

namespace opal {
namespace {

/// The identity up to `knee`, then smoothly towards 1.
float shoulder(float value) {
    constexpr float knee = 0.7f;
    if (value <= knee) return value;
    return knee + (1.0f - knee) * (1.0f - std::exp(-(value - knee) / (1.0f - knee)));
}

}  // namespace

Image tone_mapped(const Image& linear, double exposure_ev, ToneCurve tone) {
    const float exposure = float(std::exp2(exposure_ev));
    const int channels[3] = {linear.find_channel("R"), linear.find_channel("G"), linear.find_channel("B")};
    Image display;
    display.width = linear.width;
    display.height = linear.height;
    display.channel_names = {"R", "G", "B"};
    display.pixels.reserve(std::size_t(linear.width) * linear.height * 3);
    for (int y = 0; y < linear.height; ++y)
        for (int x = 0; x < linear.width; ++x) {
            const float* pixel = linear.pixel(x, y);
            float rgb[3] = {pixel[channels[0]] * exposure, pixel[channels[1]] * exposure, pixel[channels[2]] * exposure};
            const float luminance = std::max(0.0f, 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2]);
            const float lowest = std::min({rgb[0], rgb[1], rgb[2]});
            if (lowest < 0.0f) {
                const float keep = luminance > 0.0f ? luminance / (luminance - lowest) : 0.0f;
                for (float& c : rgb) c = std::max(0.0f, luminance + keep * (c - luminance));
            }
            float scale = 1.0f;
            if (tone == ToneCurve::filmic) {
                const float brightest = std::max({rgb[0], rgb[1], rgb[2]});
                scale = brightest > 0.0f ? shoulder(brightest) / brightest : 0.0f;
            }
            for (const float c : rgb) {
                const float value = std::min(1.0f, c * scale);
                display.pixels.push_back(tone == ToneCurve::none ? value : float(srgb_encoded(double(value))));
            }
        }
    return display;
}

}  // namespace opal
