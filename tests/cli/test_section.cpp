// SPDX-License-Identifier: Apache-2.0
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

class Section : public testing::Test {
  protected:
    Section() { write_opal_asset(SmallOpal().make(), folder_ / "ball.vdb"); }
    std::string at(const std::string& name) const { return (folder_ / name).string(); }
    std::string section(const std::string& arguments, const std::string& output = "out.png") const {
        return opal_model + " section " + at("ball.vdb") + " -o " + at(output) + " " + arguments;
    }

    ScratchFolder folder_;
};

TEST_F(Section, WritesTheSamePictureTwice) {
    for (const std::string arguments :
         {"", "--axis x --at 1.5 --color orientation", "--color weight", "--color sites --slices 4"}) {
        const ProgramResult result = run_program(section(arguments) + " && " + section(arguments, "again.png"));
        ASSERT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "");
        EXPECT_EQ(bytes(at("out.png")), bytes(at("again.png"))) << arguments;
    }
    ASSERT_EQ(run_program(section("--size 300 --color grain")).exit_code, 0);
    const Image picture = read_image(at("out.png"));
    EXPECT_GE(std::max(picture.width, picture.height), 300);
    EXPECT_LE(std::max(picture.width, picture.height), 450);
}

TEST_F(Section, OpalsSideBySide) {
    const ProgramResult result =
        run_program(opal_model + " section " + at("ball.vdb") + " " + at("ball.vdb") + " --size 200 -o " + at("two.png"));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const Image picture = read_image(at("two.png"));
    EXPECT_GT(picture.width, 400);
    EXPECT_LT(picture.height, 300);
}

TEST_F(Section, WhatCannotBeShownIsNamed) {
    const std::size_t files = count_files((folder_ / "").string());
    expect_failure(section("--at 3.5"), 2, "ball.vdb: --at 3.5: no section there; allowed along z: -2.9 to 2.9 mm");
    expect_failure(section("--at 1,5"), 2, "--at 1,5: expected a number, in mm");
    expect_failure(section("--at 1 --slices 3"), 2, "not both");
    expect_failure(section("--axis w"), 2, "--axis w: not known (allowed: x, y, z)");
    expect_failure(section("--color grian"), 2, "--color grian: not known; did you mean 'grain'? (allowed: grain, orientation");
    expect_failure(section("--color sigma_s_mie"), 2, "ball.vdb: no grid sigma_s_mie");
    expect_failure(section("--size 3"), 2, "--size");
    expect_failure(section("--size 4096 --slices 8"), 2, "--size 4096: 8 sections of that size are too large");
    expect_failure(section("", "out.jpg"), 2, "the name must end in .png");
    expect_failure(section("", "nowhere/out.png"), 2, "nowhere");
    expect_failure(opal_model + " section " + at("missing.vdb") + " -o " + at("out.png"), 2, "missing.vdb: no such file");
    EXPECT_EQ(count_files((folder_ / "").string()), files);
}

}  // namespace
}  // namespace opal
