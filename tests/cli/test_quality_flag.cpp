// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "../renderer/small_opal.h"
#include "formats/image.h"
#include "formats/quality.h"
#include "run_program.h"

namespace opal {
namespace {

class QualityFlag : public testing::Test {
  protected:
    QualityFlag() {
        std::ofstream(folder_ / "scene.toml")
            << "[render]\nwidth = 16\nheight = 12\nsamples = 3\n[camera]\nposition_mm = [0, -30, 12]\n"
               "[[material]]\nname = \"grey\"\nalbedo = 0.4\n[[object]]\nkind = \"sphere\"\nmaterial = \"grey\"\nradius_mm = 4\n";
    }
    std::string at(const std::string& name) const { return (folder_ / name).string(); }
    /// The resolved scene in the picture's header.
    std::string rendered(const std::string& flags) const {
        const ProgramResult result = run_program(opal_render + " " + at("scene.toml") + " -o " + at("a.exr") + " " + flags);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return read_image(at("a.exr")).attributes.at("opal:scene");
    }

    ScratchFolder folder_;
};

TEST_F(QualityFlag, StandsBetweenTheSceneAndOtherFlags) {
    EXPECT_NE(rendered("").find("samples = 3\n"), std::string::npos);
    const std::string draft = rendered("--quality draft");
    EXPECT_NE(draft.find("samples = 32\n"), std::string::npos) << draft;
    EXPECT_NE(draft.find("noise = 0.5\n"), std::string::npos) << draft;
    const std::string less = rendered("--quality reference --spp 2 --noise 0 --set render.max_bounces=7");
    EXPECT_NE(less.find("samples = 2\n"), std::string::npos) << less;
    EXPECT_NE(less.find("noise = 0\n"), std::string::npos) << less;
    EXPECT_NE(less.find("max_bounces = 7\n"), std::string::npos) << less;
    EXPECT_NE(less.find("max_odds = 1600\n"), std::string::npos) << less;
}

TEST_F(QualityFlag, UnknownOnesAreRefused) {
    expect_failure(opal_render + " " + at("scene.toml") + " -o " + at("a.exr") + " --quality finest", 2, "--quality");
}

}  // namespace
}  // namespace opal
