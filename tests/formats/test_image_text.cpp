// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "formats/image_text.h"

namespace opal {
namespace {

Image white(int width, int height) {
    Image image;
    image.width = width;
    image.height = height;
    image.channel_names = {"R", "G", "B"};
    image.pixels.assign(std::size_t(width) * std::size_t(height) * 3, 1.0f);
    return image;
}

/// First and last column and row that hold something dark.
struct Extent {
    int left = 1000, right = -1, top = 1000, bottom = -1;

    explicit Extent(const Image& image) {
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                if (image.pixel(x, y)[1] > 0.5f) continue;
                left = std::min(left, x);
                right = std::max(right, x);
                top = std::min(top, y);
                bottom = std::max(bottom, y);
            }
    }
};

TEST(ImageText, StandsWhereItIsAskedTo) {
    TextStyle style;
    style.height_px = 20;
    const int width = text_width_px("HEH", style);
    ASSERT_GT(width, 20) << "is the package fonts-dejavu-core installed?";
    for (const TextAlign align : {TextAlign::left, TextAlign::center, TextAlign::right}) {
        Image image = white(200, 60);
        style.align = align;
        ASSERT_TRUE(draw_text(image, 100, 30, "HEH", style));
        const Extent extent(image);
        const int left = align == TextAlign::left ? 100 : align == TextAlign::center ? 100 - width / 2 : 100 - width;
        EXPECT_NEAR(extent.left, left, 3);
        EXPECT_NEAR(extent.right, left + width, 3);
        // Capitals, middle on the line.
        EXPECT_NEAR(0.5 * (extent.top + extent.bottom), 30.0, 1.5);
    }
}

TEST(ImageText, IsCutAtTheEdge) {
    Image image = white(30, 20);
    EXPECT_TRUE(draw_text(image, 15, 5, "WIDER THAN THE IMAGE", {}));
    EXPECT_EQ(Extent(image).right, 29);
}

TEST(ImageText, WithoutAFontNothingIsDrawn) {
    TextStyle style;
    style.font = "no-font-of-this-name";
    Image image = white(100, 40);
    EXPECT_FALSE(draw_text(image, 10, 20, "text", style));
    EXPECT_EQ(text_width_px("text", style), 0);
    EXPECT_TRUE(image.pixels == white(100, 40).pixels);
}

}  // namespace
}  // namespace opal
