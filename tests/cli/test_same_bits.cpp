// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <sstream>

#include "../renderer/small_opal.h"
#include "formats/opal_asset_io.h"
#include "run_program.h"

namespace opal {
namespace {

std::string bytes(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

/// The file without what OpenVDB puts there anew each time: the identifier in its header. Offsets of the header: magic (8), file
/// version (4), library version (8), grid offsets flag (1), then 36 characters.
std::string content_of_vdb(const std::filesystem::path& path) {
    std::string content = bytes(path);
    const std::size_t identifier = 8 + 4 + 8 + 1;
    if (content.size() > identifier + 36) content.replace(identifier, 36, 36, '-');
    return content;
}

TEST(SameBits, AcrossThreadsAndRuns) {
    const ScratchFolder folder;
    const std::string recipe = examples + "/precious_opal/recipe.toml", scene = examples + "/precious_opal/scene.toml";
    const auto model = [&](const std::string& name, int threads) {
        const ProgramResult result = run_program(opal_model + " build " + recipe + " -o " + (folder / name).string() +
                                                 " --set grains.voxel_size_mm=0.1 --threads " + std::to_string(threads));
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return content_of_vdb(folder / name);
    };
    const std::string one = model("one.vdb", 1);
    EXPECT_TRUE(one == model("two.vdb", 2)) << "the .vdb depends on the number of threads";
    EXPECT_TRUE(one == model("again.vdb", 2)) << "the .vdb differs between two runs";

    const auto render = [&](const std::string& name, int threads) {
        const ProgramResult result =
            run_program(opal_render + " " + scene + " -o " + (folder / name).string() +
                        " --set object.0.file=" + (folder / "one.vdb").string() +
                        " --set render.width=96 --set render.height=72 --spp 8 --threads " + std::to_string(threads));
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return bytes(folder / name);
    };
    const std::string picture = render("one.exr", 1);
    EXPECT_TRUE(picture == render("two.exr", 2)) << "the EXR depends on the number of threads";
    EXPECT_TRUE(picture == render("again.exr", 2)) << "the EXR differs between two runs";
}

}  // namespace
}  // namespace opal
