// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>

#include "../renderer/small_opal.h"
#include "formats/image.h"
#include "run_program.h"

namespace opal {
namespace {

class Animation : public testing::Test {
  protected:
    Animation() {
        SmallOpal small;
        small.voxel_mm = 0.3;
        write_opal_asset(small.make(), folder_ / "opal.vdb");
        std::ofstream(folder_ / "scene.toml")
            << "[render]\nwidth = 40\nheight = 30\nsamples = 2\n[camera]\nposition_mm = [0, -20, 8]\n"
               "[[material]]\nname = \"grey\"\n[[object]]\nkind = \"opal\"\nfile = \"opal.vdb\"\ntranslate_mm = [1, 0, 0]\n"
               "[[object]]\nkind = \"plane\"\nmaterial = \"grey\"\ntranslate_mm = [0, 0, -4]\n"
               "[animation]\nframes = 4\nturntable_deg = 30\ncenter_mm = [1, 0, 0]\nlight_sweep_deg = 10\n";
    }

    ProgramResult render(const std::string& output, const std::string& flags) const {
        return run_program(opal_render + " " + at("scene.toml") + " -o " + at(output) + " " + flags);
    }
    std::string at(const std::string& name) const { return (folder_ / name).string(); }

    ScratchFolder folder_;
};

/// Each frame is the still that has its transforms, to the bit.
TEST_F(Animation, FramesAreTheStillsTheyStandFor) {
    const ProgramResult all = render("turn.exr", "--frames 2:3");
    ASSERT_EQ(all.exit_code, 0) << all.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "turn.0001.exr"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "turn.exr"));
    ASSERT_TRUE(std::filesystem::exists(folder_ / "turn.0002.png"));
    ASSERT_TRUE(std::filesystem::exists(folder_ / "turn.sheet.png"));
    const ProgramResult still =
        render("still.exr", "--set animation.frames=1 --set 'object.0.rotate_deg=[0, 0, 60]' --set environment.rotate_deg=20");
    ASSERT_EQ(still.exit_code, 0) << still.err;
    const Image frame = read_image(folder_ / "turn.0003.exr"), same = read_image(folder_ / "still.exr");
    EXPECT_EQ(frame.pixels, same.pixels);
    EXPECT_EQ(frame.attributes.at("opal:scene"), same.attributes.at("opal:scene"));
    EXPECT_NE(read_image(folder_ / "turn.0002.exr").pixels, same.pixels);

    const ProgramResult one = render("one.exr", "--frame 3 --threads 1");
    ASSERT_EQ(one.exit_code, 0) << one.err;
    EXPECT_EQ(read_image(folder_ / "one.0003.exr").pixels, same.pixels);
}

/// Frames that are there and finished are not made again; others are.
TEST_F(Animation, ResumeSkipsFinishedFrames) {
    ASSERT_EQ(render("turn.exr", "--frames 1:2").exit_code, 0);
    const auto when = std::filesystem::last_write_time(folder_ / "turn.0002.exr");
    std::filesystem::remove(folder_ / "turn.0001.exr");
    ProgramResult again = render("turn.exr", "--frames 1:3 --resume");
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(std::filesystem::last_write_time(folder_ / "turn.0002.exr"), when);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "turn.0001.exr"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "turn.0003.exr"));
    // With another scene the frame is another.
    again = render("turn.exr", "--frame 2 --resume --set camera.vertical_fov_deg=30");
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_NE(std::filesystem::last_write_time(folder_ / "turn.0002.exr"), when);
}

TEST_F(Animation, BadFrames) {
    expect_failure(opal_render + " " + at("scene.toml") + " -o " + at("a.exr") + " --frames 3:5", 2,
                   "--frames 3:5: the scene has frames 1 to 4");
    expect_failure(opal_render + " " + at("scene.toml") + " -o " + at("a.exr") + " --frame 1 --set animation.frames=1", 2,
                   "the scene has no [animation]");
    expect_failure(opal_render + " " + at("scene.toml") + " -o " + at("a.exr") + " --crop 0,0,41,30", 2,
                   "render.crop: [0, 0, 41, 30] is no part of the picture");
    expect_failure(opal_render + " " + at("scene.toml") + " -o " + at("a.exr") + " --crop 1,2,3", 2,
                   "--crop 1,2,3: expected four whole numbers");
}

}  // namespace
}  // namespace opal
