// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>

#include "../renderer/small_opal.h"
#include "formats/image.h"
#include "formats/opal_asset.h"
#include "run_program.h"

namespace opal {
namespace {

TEST(Interrupt, ControlCWritesWhatIsThere) {
    const ScratchFolder folder;
    write_opal_asset(SmallOpal().make(), folder / "opal.vdb");
    std::ofstream(folder / "scene.toml")
        << "[render]\nwidth = 160\nheight = 120\nsamples = 1000000\n[camera]\nposition_mm = [0, -20, 8]\n"
           "[[object]]\nkind = \"opal\"\nfile = \"opal.vdb\"\n";
    const std::string output = (folder / "out.exr").string();
    const ProgramResult result = run_program("timeout --preserve-status --signal=INT 4 " + opal_render + " " +
                                             (folder / "scene.toml").string() + " -o " + output);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("interrupted; wrote what is there"), std::string::npos) << result.out;
    const Image image = read_image(output);
    const int count = image.find_channel("sample_count");
    ASSERT_GE(count, 0);
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x) ASSERT_GE(image.pixel(x, y)[count], 1.0f);
    EXPECT_TRUE(std::filesystem::exists(folder / "out.png"));
}

TEST(Interrupt, TimeLimitEndsARender) {
    const ScratchFolder folder;
    write_opal_asset(SmallOpal().make(), folder / "opal.vdb");
    std::ofstream(folder / "scene.toml")
        << "[render]\nwidth = 80\nheight = 60\nsamples = 1000000\n[[object]]\nkind = \"opal\"\nfile = \"opal.vdb\"\n";
    const ProgramResult result = run_program("timeout 60 " + opal_render + " " + (folder / "scene.toml").string() + " -o " +
                                             (folder / "out.exr").string() + " --time 2s");
    EXPECT_EQ(result.exit_code, 0) << result.err;
}

}  // namespace
}  // namespace opal
