// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "../renderer/small_opal.h"
#include "formats/image.h"
#include "run_program.h"

namespace opal {
namespace {

std::string bytes(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

class Develop : public testing::Test {
  protected:
    Develop() {
        std::ofstream(folder_ / "scene.toml")
            << "[render]\nwidth = 40\nheight = 30\nsamples = 4\n[camera]\nposition_mm = [0, -30, 12]\n"
               "[film]\nexposure_ev = 0.7\nwhite = \"A\"\n[[material]]\nname = \"red\"\nalbedo = [0.8, 0.2, 0.1]\n"
               "[[object]]\nkind = \"sphere\"\nmaterial = \"red\"\nradius_mm = 4\n";
        render("a.exr", "");
    }
    void render(const std::string& output, const std::string& flags) const {
        const ProgramResult result = run_program(opal_render + " " + at("scene.toml") + " -o " + at(output) + " " + flags);
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }
    void develop(const std::string& picture, const std::string& output, const std::string& flags) const {
        const ProgramResult result = run_program(opal_render + " develop " + at(picture) + " -o " + at(output) + " " + flags);
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }
    std::string at(const std::string& name) const { return (folder_ / name).string(); }

    ScratchFolder folder_;
};

TEST_F(Develop, WithoutFlagsIsTheRendersOwnPng) {
    develop("a.exr", "b.png", "");
    EXPECT_TRUE(bytes(folder_ / "b.png") == bytes(folder_ / "a.png"));
    develop("a.exr", "c.png", "--exposure 0.7 --white A --tone filmic");
    EXPECT_TRUE(bytes(folder_ / "c.png") == bytes(folder_ / "a.png"));
    develop("a.exr", "d.png", "--exposure 0.2");
    EXPECT_FALSE(bytes(folder_ / "d.png") == bytes(folder_ / "a.png"));
}

/// The settings after the fact give the picture that the scene gives with them.
TEST_F(Develop, IsTheRenderWithThoseSettings) {
    render("set.exr", "--set film.exposure_ev=1.5 --set film.tone=srgb");
    develop("a.exr", "b.png", "--exposure 1.5 --tone srgb");
    EXPECT_TRUE(bytes(folder_ / "b.png") == bytes(folder_ / "set.png"));
    // The film's RGB is stored in floats: a level of the PNG may tip over.
    render("day.exr", "--set film.white=D65");
    develop("a.exr", "day_again.png", "--white D65");
    const Image day = read_image(folder_ / "day.png"), again = read_image(folder_ / "day_again.png");
    for (std::size_t i = 0; i < day.pixels.size(); ++i) EXPECT_NEAR(again.pixels[i], day.pixels[i], 1.01f / 255.0f);
    EXPECT_NE(day.pixels, read_image(folder_ / "a.png").pixels);
}

TEST_F(Develop, CropsAgreeWhereverTheyAreMade) {
    render("part.exr", "--crop 10,5,32,20");
    develop("a.exr", "part_again.png", "--crop 10,5,32,20");
    EXPECT_TRUE(bytes(folder_ / "part_again.png") == bytes(folder_ / "part.png"));
    develop("part.exr", "small.png", "--crop 12,6,13,9");
    const Image small = read_image(folder_ / "small.png");
    EXPECT_EQ(small.width, 1);
    EXPECT_EQ(small.height, 3);
}

TEST_F(Develop, BadInput) {
    const std::string develop = opal_render + " develop ", out = " -o " + at("x.png");
    expect_failure(develop + at("none.exr") + out, 2, "none.exr: no such image file");
    expect_failure(develop + at("a.exr") + " -o " + at("x.exr"), 2, "must end in .png");
    expect_failure(develop + at("a.exr") + out + " --white 7K", 2, "--white 7K: allowed: D65, A, E or");
    expect_failure(develop + at("a.exr") + out + " --tone warm", 2, "warm");
    expect_failure(develop + at("a.exr") + out + " --exposure nan", 2, "--exposure");
    expect_failure(develop + at("a.exr") + out + " --crop 0,0,50,2", 2, "--crop 0,0,50,2: the picture holds x 0 to 40");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "x.png"));
}

/// A viewer that is not there is told and changes nothing.
TEST_F(Develop, RenderingWithoutItsViewer) {
    const ProgramResult result =
        run_program(opal_render + " " + at("scene.toml") + " -o " + at("tev.exr") + " --tev localhost:1");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("no viewer answers at localhost:1"), std::string::npos) << result.err;
    EXPECT_EQ(read_image(folder_ / "tev.exr").pixels, read_image(folder_ / "a.exr").pixels);
    expect_failure(opal_render + " " + at("scene.toml") + " -o " + at("tev.exr") + " --tev localhost:x", 2, "--tev localhost:x");
}

TEST_F(Develop, RefusesPicturesThatAreNoNumbers) {
    Image picture = read_image(folder_ / "a.exr");
    picture.pixel(5, 2)[0] = std::nanf("");
    picture.pixel(7, 3)[1] = INFINITY;
    picture.pixel(7, 3)[2] = INFINITY;
    write_exr(folder_ / "broken.exr", picture);
    const std::string develop_broken = opal_render + " develop " + at("broken.exr") + " -o " + at("b.png");
    expect_failure(develop_broken, 2, "broken.exr: 2 pixels are not finite numbers, the first at (5, 2); --blacken");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "b.png"));
    expect_failure(opal_render + " compare " + at("a.exr") + " " + at("broken.exr"), 2, "broken.exr: 2 pixels are not finite");
    develop("broken.exr", "b.png", "--blacken");
    const Image shown = read_image(folder_ / "b.png"), whole = read_image(folder_ / "a.png");
    for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(shown.pixel(5, 2)[c], 0.0f);
        EXPECT_EQ(shown.pixel(7, 3)[c], 0.0f);
        EXPECT_EQ(shown.pixel(6, 2)[c], whole.pixel(6, 2)[c]);
    }
    // What lies outside the crop does not matter.
    develop("broken.exr", "c.png", "--crop 0,0,5,5");
}

}  // namespace
}  // namespace opal
