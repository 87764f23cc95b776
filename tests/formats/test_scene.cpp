// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "expect_error.h"
#include "formats/scene.h"

namespace opal {
namespace {

const std::string minimal = "[[object]]\nkind = \"opal\"\nfile = \"gem.vdb\"\n";

SceneDescription parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return parse_scene(text, "folder/s.toml", overrides);
}

TEST(Scene, Defaults) {
    const SceneDescription scene = parse(minimal);
    EXPECT_EQ(scene.render.width, 960);
    EXPECT_EQ(scene.render.max_bounces, 64);
    EXPECT_EQ(scene.opal.companions, 3);
    EXPECT_EQ(scene.environment.kind, EnvironmentKind::studio);
    EXPECT_EQ(scene.opal.grains, GrainsKind::automatic);
}

TEST(Scene, GrainsByName) {
    EXPECT_EQ(parse(minimal, {"opal.grains=cells"}).opal.grains, GrainsKind::cells);
    EXPECT_EQ(parse(minimal, {"opal.grains=sphere-tracing"}).opal.grains, GrainsKind::sphere_tracing);
    EXPECT_NE(scene_to_toml(parse(minimal, {"opal.grains=hyperboloid"})).find("grains = \"hyperboloid\""), std::string::npos);
    EXPECT_INPUT_ERROR(parse(minimal, {"opal.grains=cell"}), "did you mean 'cells'?");
}

TEST(Scene, PathsAreRelativeToTheFileThatHoldsThem) {
    EXPECT_EQ(parse(minimal).objects[0].file, std::filesystem::path("folder/gem.vdb"));
    EXPECT_EQ(parse(minimal, {"object.0.file=other.vdb"}).objects[0].file, std::filesystem::path("other.vdb"));
    EXPECT_EQ(parse(minimal, {"object.0.file='/a/b.vdb'"}).objects[0].file, std::filesystem::path("/a/b.vdb"));
}

TEST(Scene, ResolvedTextReadsBackToTheSameText) {
    const SceneDescription scene = parse(minimal +
                                         "[[material]]\nname = \"stand\"\nalbedo = 0.7\n[[object]]\nkind = \"cylinder\"\n"
                                         "material = \"stand\"\n[film]\naovs = [\"depth\", \"normal\"]\n");
    const std::string text = scene_to_toml(scene);
    EXPECT_EQ(scene_to_toml(parse_scene(text, "x.toml", {})), text);
}

TEST(Scene, FilterRadiusFollowsTheFilter) {
    EXPECT_EQ(parse(minimal).render.filter_radius_px, 1.0);
    EXPECT_EQ(parse(minimal + "[render]\nfilter = \"box\"\n").render.filter_radius_px, 0.5);
    EXPECT_EQ(parse(minimal + "[render]\nfilter = \"gaussian\"\n").render.filter_radius_px, 1.5);
    EXPECT_EQ(parse(minimal + "[render]\nfilter = \"blackman-harris\"\n").render.filter_radius_px, 2.0);
    EXPECT_EQ(parse(minimal + "[render]\nfilter = \"box\"\nfilter_radius_px = 2\n").render.filter_radius_px, 2.0);
}

TEST(Scene, CropLiesWithinThePicture) {
    const std::string small = minimal + "[render]\nwidth = 64\nheight = 48\ncrop = ";
    EXPECT_EQ(parse(small + "[8, 16, 64, 17]\n").render.window(), (PixelWindow{8, 16, 64, 17}));
    EXPECT_EQ(parse(minimal).render.window(), (PixelWindow{0, 0, 960, 720}));
    for (const char* bad : {"[0, 0, 65, 48]", "[0, 0, 64, 49]", "[-1, 0, 4, 4]", "[4, 0, 4, 4]", "[0, 5, 4, 4]"})
        EXPECT_INPUT_ERROR(parse(small + bad + "\n"),
                           "is no part of the picture; allowed: [x0, y0, x1, y1] with 0 <= x0 < x1 <= 64");
    for (const char* bad : {"[0, 0, 4]", "3", "[0, 0, 4, 4.5]", "[0, 0, 4, 4, 4]"})
        EXPECT_INPUT_ERROR(parse(small + bad + "\n"), "render.crop: expected");
}

TEST(Scene, ErrorsAreLocated) {
    EXPECT_INPUT_ERROR(parse(""), "the scene is empty");
    EXPECT_INPUT_ERROR(parse(minimal + "[render]\nsamples = 0\n"), "folder/s.toml:5:11: render.samples: 0 is out of range");
    EXPECT_INPUT_ERROR(parse(minimal + "[render]\nwidht = 3\n"), "unknown key 'render.widht'; did you mean 'width'?");
    EXPECT_INPUT_ERROR(parse(minimal + "[camera]\nposition_mm = [0, 0]\n"), "expected [x, y, z], found 2 elements");
    EXPECT_INPUT_ERROR(parse(minimal + "[camera]\nup = [0, nan, 1]\n"), "camera.up: nan is out of range");
    EXPECT_INPUT_ERROR(parse(minimal + "[camera]\nposition_mm = [0, 0, 9]\ntarget_mm = [0, 0, 0]\n"),
                       "must not point along the view");
    EXPECT_INPUT_ERROR(parse(minimal + "[opal]\ndiffraction = \"two beam\"\n"), "did you mean 'two-beam'?");
    EXPECT_INPUT_ERROR(parse(minimal + "[environment]\nkind = \"file\"\n"), "needs a lat-long image");
    EXPECT_INPUT_ERROR(parse("[[object]]\nkind = \"plane\"\nmaterial = \"gold\"\n"), "object.0.material: 'gold' is not known");
    EXPECT_INPUT_ERROR(parse("[[object]]\nkind = \"plane\"\n"), "object.0.material: is needed");
    EXPECT_INPUT_ERROR(parse("[object]\nkind = \"plane\"\n"), "expected tables written as [[object]]");
    EXPECT_INPUT_ERROR(parse(minimal, {"object.1.file=x.vdb"}), "there are 1 entries");
}

}  // namespace
}  // namespace opal
