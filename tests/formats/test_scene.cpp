// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "expect_error.h"
#include "formats/scene.h"
#include "formats/text.h"

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

TEST(Scene, LightAndTrackingByName) {
    const SceneDescription scene = parse(minimal, {"environment.kind=tent", "opal.tracking=ratio"});
    EXPECT_EQ(scene.environment.kind, EnvironmentKind::tent);
    EXPECT_EQ(scene.opal.tracking, TrackingKind::ratio);
    const SceneDescription again = parse(scene_to_toml(scene));
    EXPECT_EQ(again.environment.kind, EnvironmentKind::tent);
    EXPECT_EQ(again.opal.tracking, TrackingKind::ratio);
    EXPECT_EQ(parse(minimal).opal.tracking, TrackingKind::residual);
    EXPECT_INPUT_ERROR(parse(minimal, {"opal.tracking=ration"}), "did you mean 'ratio'?");
    EXPECT_INPUT_ERROR(parse(minimal, {"environment.kind=tents"}), "did you mean 'tent'?");
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

const std::string glass = "[[material]]\nname = \"m\"\nkind = \"dielectric\"\n";

TEST(Scene, MaterialsOfEveryKindReadBack) {
    const SceneDescription scene =
        parse(glass +
              "n = \"silica\"\nroughness = 0.2\nmedium = { absorber = \"pink-dye\", sigma_a_per_mm = 0.1, sigma_s_per_mm = 0.3, "
              "asymmetry = 0.5, density_file = \"fog.vdb\", density_grid = \"d\", density_scale = 2.0 }\n"
              "[[material]]\nname = \"ring\"\nkind = \"conductor\"\nmetal = \"rhodium\"\nroughness = 0.1\n"
              "[[material]]\nname = \"stand\"\nkind = \"plastic\"\nalbedo = [0.1, 0.2, 0.3]\nn = 1.6\n"
              "[[object]]\nkind = \"sphere\"\nmaterial = \"m\"\npriority = 3\n"
              "[[object]]\nkind = \"mesh\"\nfile = \"ring.obj\"\nmaterial = \"ring\"\nsmooth_normals_deg = 40\n"
              "[[object]]\nkind = \"opal\"\nfile = \"gem.vdb\"\nroughness = 0.05\nexact = true\n");
    EXPECT_EQ(scene.materials[0].kind, MaterialKind::dielectric);
    EXPECT_EQ(scene.materials[0].n.name(), "silica");
    EXPECT_EQ(scene.materials[0].medium.density_file, std::filesystem::path("folder/fog.vdb"));
    EXPECT_EQ(scene.materials[1].metal, "rhodium");
    EXPECT_EQ(scene.materials[2].n.at(500.0), 1.6);
    EXPECT_EQ(scene.objects[0].priority, 3);
    EXPECT_EQ(scene.objects[1].smooth_normals_deg, 40.0);
    EXPECT_TRUE(scene.objects[2].exact);
    EXPECT_EQ(scene.objects[2].roughness, 0.05);
    const std::string text = scene_to_toml(scene);
    EXPECT_EQ(scene_to_toml(parse_scene(text, "x.toml", {})), text);
}

TEST(Scene, ErrorsOfMaterials) {
    EXPECT_INPUT_ERROR(parse(glass + "roughness = 0.0001\n" + minimal),
                       "0.0001 is out of range; allowed: 0 (smooth) or 0.001 to 1");
    EXPECT_INPUT_ERROR(parse(glass + "albedo = 0.5\n" + minimal), "unknown key 'material.0.albedo'");
    EXPECT_INPUT_ERROR(parse(glass + "n = \"silika\"\n" + minimal), "did you mean 'silica'?");
    EXPECT_INPUT_ERROR(parse(glass + "medium = { absorber = \"pink\" }\n" + minimal),
                       "folder/s.toml:4:23: material.0.medium.absorber");
    EXPECT_INPUT_ERROR(parse("[[material]]\nname = \"r\"\nkind = \"conductor\"\nmetal = \"rodium\"\n" + minimal),
                       "did you mean 'rhodium'?");
    EXPECT_INPUT_ERROR(parse(glass + "[[object]]\nkind = \"plane\"\nmaterial = \"m\"\n"), "a plane encloses nothing");
    EXPECT_INPUT_ERROR(parse("[[material]]\nname = \"d\"\n[[object]]\nkind = \"sphere\"\nmaterial = \"d\"\npriority = 1\n"),
                       "unknown key 'object.0.priority'");
}

TEST(Scene, LightsReadBack) {
    const std::string lights =
        "[[light]]\nkind = \"area\"\nposition_mm = [0, 0, 50]\nwidth_mm = 3\n[[light]]\nkind = \"area\"\nradius_mm = 4\n"
        "[[light]]\nkind = \"sphere\"\nilluminant = \"blackbody\"\ntemperature_k = 2700\n[[light]]\nkind = \"spot\"\n"
        "cone_deg = 20\nvisible = false\n[[light]]\nkind = \"sun\"\ncolor = [1, 0.5, 0.2]\nelevation_deg = 10\n";
    const SceneDescription scene = parse(minimal + lights);
    ASSERT_EQ(scene.lights.size(), 5u);
    EXPECT_FALSE(scene.lights[0].disk);
    EXPECT_TRUE(scene.lights[1].disk);
    EXPECT_EQ(scene.lights[4].angular_diameter_deg, 0.53);
    const std::string text = scene_to_toml(scene);
    EXPECT_EQ(scene_to_toml(parse_scene(text, "x.toml", {})), text);
    const auto light = [&](const std::string& keys) { return parse(minimal + "[[light]]\n" + keys); };
    EXPECT_INPUT_ERROR(light("radius_mm = 1\n"), "light.0.kind: is needed; allowed: area, sphere, spot, sun");
    EXPECT_INPUT_ERROR(light("kind = \"sphere\"\nwidth_mm = 1\n"), "unknown key 'light.0.width_mm'");
    EXPECT_INPUT_ERROR(light("kind = \"area\"\nradius_mm = 1\nwidth_mm = 1\n"), "is for a rectangle");
    EXPECT_INPUT_ERROR(light("kind = \"area\"\nposition_mm = [9, 0, 0]\nup = [-2, 0, 0]\n"), "must not point along");
    EXPECT_INPUT_ERROR(light("kind = \"spot\"\nposition_mm = [0, 0, 0]\n"), "is where the light stands");
    EXPECT_INPUT_ERROR(light("kind = \"spot\"\nradius_mm = 0\n"), "light.0.radius_mm: 0 is out of range");
    EXPECT_INPUT_ERROR(light("kind = \"sun\"\nradiance = 1\n"), "unknown key 'light.0.radiance'");
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
    EXPECT_INPUT_ERROR(parse(minimal, {"camera.vertical_fov_deg=9007199254740993"}), "is out of range");
    EXPECT_INPUT_ERROR(parse(minimal, {"camera.position_mm=[9007199254740993,0,0]"}), "is out of range");
}

TEST(Scene, MinusZeroIsZero) {
    const std::string text = scene_to_toml(parse(minimal, {"object.0.translate_mm=[0.0,-0.0,-0.00]"}));
    EXPECT_EQ(scene_to_toml(parse_scene(text, "x.toml", {})), text);
    EXPECT_EQ(text.find("-0"), std::string::npos);
}

TEST(Scene, ControlCharactersOfNamesSurvive) {
    const std::string text = "[[object]]\nkind = \"opal\"\nfile = \"a.vdb\"\nname = \"x\\n\\t\\u001b[31m\\u007f\"\n";
    const SceneDescription scene = parse_scene(text, "test.toml", {});
    EXPECT_EQ(scene.objects[0].name, "x\n\t\x1b[31m\x7f");
    EXPECT_EQ(parse_scene(scene_to_toml(scene), "test.toml", {}).objects[0].name, scene.objects[0].name);
    EXPECT_EQ(one_line(scene.objects[0].name), "x\\n\\t\\x1b[31m\\x7f");
}

}  // namespace
}  // namespace opal
