// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "expect_error.h"
#include "formats/animation.h"

namespace opal {
namespace {

const std::string scene_text =
    "[camera]\nposition_mm = [0, -40, 10]\ntarget_mm = [2, 0, 1]\nup = [0.6, 0, 0.8]\n[environment]\nrotate_deg = 12\n"
    "[[material]]\nname = \"m\"\n"
    "[[object]]\nkind = \"opal\"\nfile = \"gem.vdb\"\ntranslate_mm = [3, 1, 5]\nrotate_deg = [20, 30, 40]\n"
    "[[object]]\nkind = \"sphere\"\nname = \"ball\"\nmaterial = \"m\"\ntranslate_mm = [7, 2, 0]\n";

SceneDescription parse(const std::string& animation) {
    return parse_scene(scene_text + "[animation]\n" + animation, "a.toml", {});
}

void expect_near(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1.0e-12) << i;
}

TEST(Animation, TheFirstFrameIsTheSceneAsItStands) {
    const SceneDescription scene = parse("frames = 72\nturntable_deg = 5\nlight_sweep_deg = 3\ncamera_orbit_deg = 1\n");
    SceneDescription still = scene;
    still.animation = {};
    EXPECT_EQ(scene_to_toml(scene_of_frame(scene, 1)), scene_to_toml(still));
}

TEST(Animation, TurntableTurnsOpalsAboutItsCenter) {
    const SceneDescription scene = parse("frames = 19\nturntable_deg = 5\ncenter_mm = [1, 1, 0]\n");
    const SceneDescription quarter = scene_of_frame(scene, 19);
    expect_near(quarter.objects[0].translate_mm, {1.0, 3.0, 5.0});
    expect_near(quarter.objects[0].rotate_deg, {20.0, 30.0, 130.0});
    expect_near(quarter.objects[1].translate_mm, {7.0, 2.0, 0.0});
    expect_near(quarter.camera.position_mm, scene.camera.position_mm);
}

TEST(Animation, NamedObjectsRideTheTurntableAlone) {
    const SceneDescription scene = parse("frames = 3\nturntable_deg = 90\nturntable_objects = [\"ball\"]\n");
    const SceneDescription turned = scene_of_frame(scene, 2);
    expect_near(turned.objects[0].translate_mm, {3.0, 1.0, 5.0});
    expect_near(turned.objects[1].translate_mm, {-2.0, 7.0, 0.0});
    EXPECT_INPUT_ERROR(scene_of_frame(parse("frames = 2\nturntable_objects = [\"bowl\"]\n"), 1), "the name 'bowl'");
}

TEST(Animation, LightsAndCameraTurn) {
    const SceneDescription scene = parse("frames = 10\nlight_sweep_deg = -7\ncamera_orbit_deg = 90\n");
    const SceneDescription turned = scene_of_frame(scene, 2);
    EXPECT_EQ(turned.environment.rotate_deg, 5.0);
    expect_near(turned.camera.position_mm, {42.0, -2.0, 10.0});
    expect_near(turned.camera.up, {0.0, 0.6, 0.8});
    expect_near(turned.camera.target_mm, scene.camera.target_mm);
}

TEST(Animation, LightsTurnAboutTheCenter) {
    const SceneDescription scene = parse(
        "frames = 10\nlight_sweep_deg = 90\ncenter_mm = [1, 0, 0]\n[[light]]\nkind = \"area\"\nposition_mm = [5, 0, 9]\n"
        "target_mm = [1, 2, 0]\nup = [0, 1, 0]\n[[light]]\nkind = \"sun\"\nazimuth_deg = 30\n");
    const SceneDescription turned = scene_of_frame(scene, 2);
    expect_near(turned.lights[0].position_mm, {1.0, 4.0, 9.0});
    expect_near(turned.lights[0].target_mm, {-1.0, 0.0, 0.0});
    expect_near(turned.lights[0].up, {-1.0, 0.0, 0.0});
    EXPECT_EQ(turned.lights[1].azimuth_deg, 120.0);
    // What a frame is goes into its file's header, and has to be a scene.
    EXPECT_EQ(scene_to_toml(parse_scene(scene_to_toml(turned), "x.toml", {})), scene_to_toml(turned));
}

TEST(Animation, TextReadsBack) {
    const std::string text = scene_to_toml(parse("frames = 5\nturntable_deg = 2.5\nturntable_objects = [\"ball\"]\n"));
    EXPECT_NE(text.find("turntable_objects = [\"ball\"]"), std::string::npos) << text;
    EXPECT_EQ(scene_to_toml(parse_scene(text, "x.toml", {})), text);
}

TEST(Animation, FramesOfTheCommandLine) {
    EXPECT_EQ(parse_frames("3:5", 5).first, 3);
    EXPECT_EQ(parse_frames("3:5", 5).last, 5);
    EXPECT_EQ(parse_frames("4", 5).last, 4);
    for (const char* bad : {"0:2", "3:2", "1:6", "a:b", "", "1:", ":3", "1:2:3", "-1"})
        EXPECT_INPUT_ERROR(parse_frames(bad, 5), "--frames");
    EXPECT_EQ(frame_path("out/turn.exr", 7), std::filesystem::path("out/turn.0007.exr"));
    EXPECT_INPUT_ERROR(parse("frames = 0\n"), "animation.frames: 0 is out of range");
    EXPECT_INPUT_ERROR(parse("frams = 3\n"), "did you mean 'frames'?");
}

}  // namespace
}  // namespace opal
