// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "expect_error.h"
#include "formats/image.h"

namespace opal {
namespace {

TEST(Image, ExrKeepsFloatsChannelsAndText) {
    const auto path = std::filesystem::temp_directory_path() / "opal_image_test.exr";
    Image image;
    image.width = 3;
    image.height = 2;
    image.channel_names = {"R", "G", "B", "variance.R"};
    for (int i = 0; i < 24; ++i) image.pixels.push_back(0.1f * float(i) - 0.5f);
    image.attributes["opal:scene"] = "[render]\nwidth = 3\n";
    write_exr(path, image);
    const Image back = read_image(path);
    EXPECT_EQ(back.width, 3);
    ASSERT_GE(back.find_channel("variance.R"), 0);
    EXPECT_EQ(back.pixel(2, 1)[back.find_channel("variance.R")], image.pixel(2, 1)[3]);
    EXPECT_EQ(back.pixel(1, 1)[back.find_channel("G")], image.pixel(1, 1)[1]);
    EXPECT_EQ(back.attributes.at("opal:scene"), image.attributes["opal:scene"]);
    std::filesystem::remove(path);
}

TEST(Image, PngKeepsEightBitsAndClamps) {
    const auto path = std::filesystem::temp_directory_path() / "opal_image_test.png";
    Image image;
    image.width = 5;
    image.height = 2;
    image.channel_names = {"R", "G", "B"};
    for (int i = 0; i < 30; ++i) image.pixels.push_back(float(i) / 24.0f - 0.1f);
    write_png(path, image);
    const Image back = read_image(path);
    ASSERT_EQ(back.width, 5);
    ASSERT_EQ(back.height, 2);
    ASSERT_EQ(back.num_channels(), 3);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        EXPECT_NEAR(back.pixels[i], std::clamp(image.pixels[i], 0.0f, 1.0f), 0.501f / 255.0f) << i;
    EXPECT_INPUT_ERROR(write_png("/no/such/folder/a.png", image), "does not exist");
    std::filesystem::remove(path);
}

TEST(Image, ReadErrors) {
    EXPECT_INPUT_ERROR(read_image("nothing.exr"), "nothing.exr: no such image file");
    const auto path = std::filesystem::temp_directory_path() / "opal_not_an_image.exr";
    std::ofstream(path) << "this is text";
    EXPECT_INPUT_ERROR(read_image(path), "not a readable image");
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace opal
