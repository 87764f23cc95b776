// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "small_opal.h"

namespace opal {
namespace {

std::string scene(const std::string& file, const std::string& render) {
    return "[render]\nwidth = 60\nheight = 44\nfilter = \"gaussian\"\n" + render +
           "[film]\nspectral = true\naovs = [\"object_id\", \"grain_id\", \"depth\", \"normal\", \"albedo\", \"hkl\"]\n"
           "[camera]\nposition_mm = [0, -20, 12]\ntarget_mm = [0, 0, 0]\n[[material]]\nname = \"m\"\n"
           "[[object]]\nkind = \"plane\"\nmaterial = \"m\"\ntranslate_mm = [0, 0, -3.1]\n"
           "[[object]]\nkind = \"opal\"\nfile = '" +
           file + "'\n";
}

/// Whatever part of a picture is drawn, a pixel's bits are the same, and the file says where the part lies.
TEST(Crop, PixelsAreThoseOfTheWholePicture) {
    SmallOpal small;
    small.voxel_mm = 0.3;
    const ScratchFolder folder;
    const std::string file = (folder / "opal.vdb").string();
    write_opal_asset(small.make(), file);
    const Image whole = render_text(scene(file, ""), 4).image;
    EXPECT_EQ(whole.full_width, 0);
    for (const PixelWindow& window : {PixelWindow{17, 9, 58, 44}, PixelWindow{30, 20, 31, 21}}) {
        Image part =
            render_text(scene(file, fmt::format("crop = [{}, {}, {}, {}]\n", window.x0, window.y0, window.x1, window.y1)), 4)
                .image;
        write_exr(folder / "part.exr", part);
        const Image read = read_image(folder / "part.exr");
        ASSERT_EQ(part.width, window.width());
        ASSERT_EQ(part.height, window.height());
        ASSERT_EQ(part.channel_names, whole.channel_names);
        for (const Image* image : {static_cast<const Image*>(&part), &read}) {
            EXPECT_EQ(image->x0, window.x0);
            EXPECT_EQ(image->y0, window.y0);
            EXPECT_EQ(image->full_width, 60);
            EXPECT_EQ(image->full_height, 44);
        }
        for (int y = 0; y < part.height; ++y)
            for (int x = 0; x < part.width; ++x)
                for (int c = 0; c < part.num_channels(); ++c)
                    ASSERT_EQ(part.pixel(x, y)[c], whole.pixel(window.x0 + x, window.y0 + y)[c])
                        << part.channel_names[c] << " of " << x << ", " << y;
        const int red = read.find_channel("R");
        EXPECT_EQ(read.pixel(0, 0)[red], part.pixel(0, 0)[0]);
    }
}

}  // namespace
}  // namespace opal
