// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "../renderer/small_opal.h"
#include "formats/image.h"
#include "formats/opal_asset.h"
#include "run_program.h"

namespace opal {
namespace {

std::string bytes_of(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

/// Nothing that was rendered is lost, whatever happens.
class Keeping : public testing::Test {
  protected:
    Keeping() {
        SmallOpal small;
        small.voxel_mm = 0.3;
        small.constants.sigma_a_per_mm = absorber_spectrum("carbon", 0.1);
        write_opal_asset(small.make(), folder_ / "opal.vdb");
        std::ofstream(folder_ / "scene.toml")
            << "[render]\nwidth = 40\nheight = 30\nsamples = 256\n[film]\naovs = [\"depth\"]\n[camera]\nposition_mm = [0, -20, "
               "8]\ntarget_mm = [0, 0, 0]\n[[object]]\nkind = \"opal\"\nfile = \"opal.vdb\"\n";
    }

    std::string at(const std::string& name) const { return (folder_ / name).string(); }
    std::string render(const std::string& output, const std::string& flags = "") const {
        return opal_render + " " + at("scene.toml") + " -o " + at(output) + " " + flags;
    }
    void expect_success(const std::string& command) const {
        const ProgramResult result = run_program(command);
        ASSERT_EQ(result.exit_code, 0) << command << "\n" << result.err;
    }
    /// Runs a render that keeps checkpoints until it has left one, and ends it by a signal: later and later until one is there.
    void break_off(const std::string& command, const std::string& signal, const std::string& checkpoint) const {
        for (double after_s = 0.4; !std::filesystem::exists(at(checkpoint)) && after_s < 60.0; after_s *= 1.5)
            run_program("timeout --signal=" + signal + " " + std::to_string(after_s) + " " + command);
        ASSERT_TRUE(std::filesystem::exists(at(checkpoint)));
    }

    ScratchFolder folder_;
};

TEST_F(Keeping, KilledAndResumedTwiceIsTheUnbrokenRender) {
    expect_success(render("whole.exr", "--spp 192"));
    const std::string broken = render("broken.exr", "--spp 192 --checkpoint 0.1s");
    break_off(broken + " --threads 1", "KILL", "broken.checkpoint");
    EXPECT_FALSE(std::filesystem::exists(at("broken.exr"))) << "the test's render must be long enough to be broken off";
    run_program("timeout --signal=KILL 0.7 " + broken + " --resume");
    expect_success(broken + " --resume --threads 1 --stats " + at("stats.json"));
    EXPECT_TRUE(bytes_of(at("whole.exr")) == bytes_of(at("broken.exr")));
    EXPECT_TRUE(bytes_of(at("whole.png")) == bytes_of(at("broken.png")));
    EXPECT_FALSE(std::filesystem::exists(at("broken.checkpoint"))) << "a finished render needs none";
    const nlohmann::json stats = nlohmann::json::parse(bytes_of(at("stats.json")));
    EXPECT_GT(stats["checkpoints"]["resumed_from"]["samples_per_pixel"], 0.0);
    EXPECT_EQ(stats["counts"]["samples"], 40 * 30 * 192);
    EXPECT_GT(stats["noise"]["chroma"]["percentile_95"], stats["noise"]["chroma"]["median"]);
}

TEST_F(Keeping, InterruptedAdaptiveRenderIsResumed) {
    const std::string flags = "--spp 400 --noise 0.06";
    expect_success(render("whole.exr", flags));
    break_off(render("broken.exr", flags + " --threads 1"), "INT", "broken.checkpoint");
    EXPECT_TRUE(std::filesystem::exists(at("broken.exr")));
    expect_success(render("broken.exr", flags + " --resume"));
    EXPECT_TRUE(bytes_of(at("whole.exr")) == bytes_of(at("broken.exr")));
}

TEST_F(Keeping, SamplesAreAddedToAFinishedRender) {
    expect_success(render("whole.exr", "--spp 40"));
    expect_success(render("grown.exr", "--spp 24 --keep-checkpoint"));
    expect_success(render("grown.exr", "--spp 40 --resume --keep-checkpoint"));
    EXPECT_TRUE(bytes_of(at("whole.exr")) == bytes_of(at("grown.exr")));
    expect_failure(render("grown.exr", "--spp 24 --resume"), 2, "already has 40 samples per pixel, more than the 24 asked for");
    expect_failure(render("grown.exr", "--spp 48 --resume --seed 2"), 2, "of another render: render.seed is 1 in the checkpoint");
    expect_failure(render("whole.exr", "--spp 48 --resume"), 2, "there is no " + at("whole.checkpoint"));
    const ProgramResult fresh = run_program(render("grown.exr", "--spp 2"));
    EXPECT_NE(fresh.err.find("starting afresh"), std::string::npos) << fresh.err;
}

TEST_F(Keeping, VanishedFolderLeavesTheStateInTheTemporaryOne) {
    std::filesystem::create_directory(at("out"));
    std::filesystem::create_directory(at("temporary"));
    const std::string flags = "--spp 192 --threads 1 --checkpoint 0.3s";
    const ProgramResult result = run_program("export TMPDIR=" + at("temporary") + "; " + render("out/lost.exr", flags) +
                                             " & sleep 0.6; rm -r " + at("out") + "; wait $!");
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_NE(result.err.find("warning: no checkpoint: "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("the render is kept in " + at("temporary")), std::string::npos) << result.err;
    ASSERT_EQ(count_files(at("temporary")), 1u);
    const std::filesystem::path kept = std::filesystem::directory_iterator(at("temporary"))->path();
    std::filesystem::create_directory(at("out"));
    std::filesystem::rename(kept, at("out/lost.checkpoint"));
    expect_success(render("out/lost.exr", flags + " --resume"));
    expect_success(render("whole.exr", flags));
    EXPECT_TRUE(bytes_of(at("whole.exr")) == bytes_of(at("out/lost.exr")));
}

TEST_F(Keeping, FullDiskEndsInOneErrorAndNothingHalfWritten) {
    const std::size_t files = count_files(at(""));
    // A limit on the size of files fails the way a full disk does; 100 KiB hold the picture, but not its state.
    const ProgramResult result = run_program("ulimit -f 200; " + render("full.exr", "--spp 128 --threads 1 --checkpoint 0.1s"));
    EXPECT_EQ(result.exit_code, 0) << "the picture itself is small: " << result.err;
    EXPECT_NE(result.err.find("warning: no checkpoint: "), std::string::npos) << result.err;
    EXPECT_EQ(count_files(at("")), files + 2);
    expect_failure("ulimit -f 4; " + render("fuller.exr", "--spp 16"), 1, "nor could the render's state be kept");
    EXPECT_EQ(count_files(at("")), files + 2);
}

TEST_F(Keeping, PartsMergeToTheWhole) {
    expect_success(render("whole.exr", "--spp 40"));
    expect_success(render("a.exr", "--spp 40 --samples 0:16"));
    expect_success(render("b.exr", "--spp 40 --samples 16:40"));
    expect_success(opal_render + " merge " + at("b.exr") + " " + at("a.exr") + " -o " + at("merged.exr"));
    const Image whole = read_image(at("whole.exr")), merged = read_image(at("merged.exr"));
    EXPECT_EQ(whole.attributes, merged.attributes);
    ASSERT_EQ(whole.channel_names, merged.channel_names);
    std::size_t different = 0;
    for (std::size_t i = 0; i < whole.pixels.size(); ++i)
        if (whole.pixels[i] != merged.pixels[i]) {
            ++different;
            EXPECT_EQ(std::nextafter(whole.pixels[i], merged.pixels[i]), merged.pixels[i]);
        }
    EXPECT_LE(different, 1u);
    EXPECT_TRUE(bytes_of(at("whole.png")) == bytes_of(at("merged.png")));

    const ProgramResult some = run_program(opal_render + " merge " + at("b.exr") + " -o " + at("some.exr"));
    EXPECT_EQ(some.exit_code, 0);
    EXPECT_NE(some.err.find("warning: samples 0:16 of each pixel are missing"), std::string::npos) << some.err;
    expect_failure(opal_render + " merge " + at("a.exr") + " " + at("a.exr") + " -o " + at("m.exr"), 2, "overlap");
    expect_failure(opal_render + " merge " + at("whole.exr") + " -o " + at("m.exr"), 2, "not a part of a render");
    expect_failure(render("c.exr", "--spp 40 --samples 16:48"), 2, "--samples 16:48: the render has 40 samples per pixel");
    expect_failure(render("c.exr", "--samples 0:8 --noise 0.1"), 2, "--samples: how many samples");
}

TEST_F(Keeping, CompareTellsHowPicturesDiffer) {
    expect_success(render("a.exr", "--spp 16"));
    expect_success(render("b.exr", "--spp 64 --seed 2"));
    expect_success(render("small.exr", "--spp 1 --set render.width=32"));
    const ProgramResult same = run_program(opal_render + " compare " + at("a.exr") + " " + at("a.exr") + " --json");
    EXPECT_EQ(nlohmann::json::parse(same.out)["relative_mse"], 0.0);
    const ProgramResult result =
        run_program(opal_render + " compare " + at("a.exr") + " " + at("b.exr") + " --json --difference " + at("difference.exr"));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const nlohmann::json report = nlohmann::json::parse(result.out);
    EXPECT_GT(report["relative_mse"], 0.0);
    EXPECT_GT(report["delta_e_2000"]["percentile_95"], report["delta_e_2000"]["mean"]);
    EXPECT_LT(report["z"]["beyond_4"], 0.01);
    EXPECT_GE(read_image(at("difference.exr")).find_channel("delta_e"), 0);
    expect_failure(opal_render + " compare " + at("a.exr") + " " + at("small.exr"), 2, "differ in size: 40x30 and 32x30");
    expect_failure(opal_render + " compare " + at("a.exr") + " " + at("gone.exr"), 2, "no such image file");
}

}  // namespace
}  // namespace opal
