// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/host/tone_mapping.h"

namespace opal {
namespace {

Image one_pixel(float r, float g, float b) {
    Image image;
    image.width = image.height = 1;
    image.channel_names = {"R", "G", "B"};
    image.pixels = {r, g, b};
    return image;
}

TEST(ToneMapping, MidGreyIsThePlainSrgbCurve) {
    const Image display = tone_mapped(one_pixel(0.18f, 0.18f, 0.18f), 0.0);
    EXPECT_NEAR(display.pixels[0], 0.4614f, 1e-3f);
}

TEST(ToneMapping, HighlightsKeepTheirHueAndStayInside) {
    const Image display = tone_mapped(one_pixel(40.0f, 20.0f, 10.0f), 0.0);
    EXPECT_LE(display.pixels[0], 1.0f);
    EXPECT_GT(display.pixels[0], display.pixels[1]);
    EXPECT_GT(display.pixels[1], display.pixels[2]);
}

TEST(ToneMapping, ColoursOutsideTheGamutKeepTheirLuminance) {
    const Image display = tone_mapped(one_pixel(-0.1f, 0.4f, 0.1f), 0.0);
    for (const float c : display.pixels) EXPECT_GE(c, 0.0f);
    const auto linear = [](float c) { return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f); };
    const float luminance =
        0.2126f * linear(display.pixels[0]) + 0.7152f * linear(display.pixels[1]) + 0.0722f * linear(display.pixels[2]);
    EXPECT_NEAR(luminance, 0.2126f * -0.1f + 0.7152f * 0.4f + 0.0722f * 0.1f, 1e-4f);
}

TEST(ToneMapping, ExposureIsInStops) {
    EXPECT_EQ(tone_mapped(one_pixel(0.1f, 0.1f, 0.1f), 1.0).pixels[0], tone_mapped(one_pixel(0.2f, 0.2f, 0.2f), 0.0).pixels[0]);
}

}  // namespace
}  // namespace opal
