// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <openvdb/tools/ValueTransformer.h>
#include <tbb/global_control.h>

#include <cmath>

#include "../formats/expect_error.h"
#include "renderer/host/grain_source.h"
#include "small_opal.h"

namespace opal {
namespace {

std::string scene_of(const std::filesystem::path& file, const std::string& settings, int seed = 1) {
    return fmt::format("[render]\nseed = {}\n", seed) +
           "width = 40\nheight = 40\nsampler = \"independent\"\nfilter = \"box\"\n"
           "[camera]\nposition_mm = [0, -20, 12]\ntarget_mm = [0, 0, 0]\nvertical_fov_deg = 10\n"
           "[[object]]\nkind = \"opal\"\nfile = '" +
           file.string() + "'\n" + settings;
}

SmallOpal colourful() {
    SmallOpal small;
    small.radius_mm = 1.5;
    small.voxel_mm = 0.03;
    small.constants.sphere_diameter_nm = 300.0;
    small.constants.sigma_a_per_mm = absorber_spectrum("carbon", 0.5);
    return small;
}

/// One picture, with cells and with voxels a sixtieth of the opal wide: the same in the mean and in every part of it.
TEST(GrainSource, CellsShowWhatFineVoxelsShow) {
    const ScratchFolder folder;
    write_opal_asset(colourful().make(), folder / "opal.vdb");
    const int samples = 200;
    // Uniform light: what differs is how long the light stays, and where it leaves.
    const std::string light = "[environment]\nkind = \"constant\"\n";
    const Rendered cells = render_text(scene_of(folder / "opal.vdb", light + "[opal]\ngrains = \"cells\"\n"), samples);
    const Rendered voxels = render_text(scene_of(folder / "opal.vdb", light + "[opal]\ngrains = \"voxels\"\n", 2), samples);
    for (const char* channel : {"R", "G", "B"}) {
        const auto difference = [&](int x0, int y0, int x1, int y1, double voxel_bias) {
            const MeanEstimate a = region_mean(cells.image, channel, x0, y0, x1, y1),
                               b = region_mean(voxels.image, channel, x0, y0, x1, y1);
            const double error = std::hypot(a.standard_error, b.standard_error);
            EXPECT_LE(std::abs(a.mean - b.mean), 4.5 * error + voxel_bias * a.mean) << channel << " at " << x0 << ", " << y0;
            return error / a.mean;
        };
        EXPECT_LT(difference(0, 0, 40, 40, 0.003), 0.01) << "too noisy to say anything";
        for (int y = 0; y < 40; y += 10)
            for (int x = 0; x < 40; x += 10) difference(x, y, x + 10, y + 10, 0.02);
    }
}

TEST(GrainSource, SitesAndShapeAreEnough) {
    const ScratchFolder folder;
    const OpalAsset asset = colourful().make();
    write_opal_asset(asset, folder / "whole.vdb");
    write_opal_asset(asset, folder / "sites.vdb", {.grids = {OutputGrid::shape, OutputGrid::sites}});
    const Rendered whole = render_text(scene_of(folder / "whole.vdb", ""), 64);
    const Rendered sites = render_text(scene_of(folder / "sites.vdb", "", 2), 64);
    // Only the grains' sizes are measured in another way.
    for (const char* channel : {"R", "G", "B"}) {
        const MeanEstimate a = region_mean(whole.image, channel, 0, 0, 40, 40),
                           b = region_mean(sites.image, channel, 0, 0, 40, 40);
        EXPECT_NEAR(a.mean, b.mean, 4.5 * std::hypot(a.standard_error, b.standard_error));
    }
    EXPECT_INPUT_ERROR(render_text(scene_of(folder / "sites.vdb", "[opal]\ngrains = \"voxels\"\n"), 1),
                       "sites.vdb: holds no grain_id, which opal.grains = \"voxels\" needs");
}

TEST(GrainSource, SizesFromCellsAndFromVoxelsAgree) {
    const OpalAsset asset = colourful().make();
    OpalAsset no_voxels = asset;
    no_voxels.grain_id = nullptr;
    std::vector<std::string> notices;
    const GrainSource with(asset, GrainsKind::automatic, "a.vdb", notices),
        without(no_voxels, GrainsKind::automatic, "a.vdb", notices);
    EXPECT_TRUE(notices.empty());
    ASSERT_EQ(with.sizes_mm().size(), without.sizes_mm().size());
    // Both count places of a lattice, 0.03 to 0.04 mm apart: little is known of grains that hold but a few.
    int compared = 0;
    for (std::size_t g = 0; g < with.sizes_mm().size(); ++g) {
        if (with.sizes_mm()[g] < 0.3f) continue;
        EXPECT_NEAR(with.sizes_mm()[g], without.sizes_mm()[g], 0.03 * with.sizes_mm()[g]) << g;
        ++compared;
    }
    EXPECT_GT(compared, 20);
}

TEST(GrainSource, ChoosesWhatTheFileDescribesExactly) {
    std::vector<std::string> notices;
    const auto method = [&](const OpalAsset& asset, GrainsKind kind) {
        return std::string(GrainSource(asset, kind, "a.vdb", notices).method_name());
    };
    OpalAsset asset = colourful().make();
    EXPECT_EQ(method(asset, GrainsKind::automatic), "cells");
    EXPECT_EQ(method(asset, GrainsKind::voxels), "voxels");
    EXPECT_TRUE(notices.empty());
    EXPECT_EQ(method(asset, GrainsKind::sphere_tracing), "sphere-tracing");
    EXPECT_EQ(method(asset, GrainsKind::hyperboloid), "hyperboloid");
    OpalAsset unlike = asset;
    for (std::size_t n = 0; n < unlike.sites.size(); ++n) unlike.sites[n].weight_mm = 0.1f * float(n % 4);
    EXPECT_EQ(method(unlike, GrainsKind::hyperboloid), "hyperboloid");
    ASSERT_EQ(notices.size(), 3u);
    EXPECT_NE(notices[0].find("a.vdb: opal.grains = \"sphere-tracing\" is there for comparison"), std::string::npos);
    EXPECT_NE(notices[1].find("nearly equal weight, here 100 % of the neighbours"), std::string::npos) << notices[1];
    EXPECT_NE(notices[2].find("nearly equal weight, here "), std::string::npos) << notices[2];
    EXPECT_EQ(notices[2].find("here 100 % of the neighbours"), std::string::npos) << notices[2];
    notices.clear();

    OpalAsset noisy = asset;
    noisy.boundary_noise.amplitude_mm = 0.1;
    EXPECT_EQ(method(noisy, GrainsKind::automatic), "voxels");
    EXPECT_INPUT_ERROR(method(noisy, GrainsKind::cells),
                       "a.vdb: opal.grains = \"cells\": boundary noise displaces the boundaries of the cells");
    OpalAsset other = asset;
    other.tessellation = TessellationKind::manhattan;
    EXPECT_EQ(method(other, GrainsKind::automatic), "voxels");
    EXPECT_INPUT_ERROR(method(other, GrainsKind::sphere_tracing), "the cells of a manhattan tessellation are of another kind");
    other.grain_id = nullptr;
    EXPECT_INPUT_ERROR(method(other, GrainsKind::automatic), "holds no grain_id, and cells cannot take its place");
    OpalAsset foreign = asset;
    foreign.sites.clear();
    EXPECT_EQ(method(foreign, GrainsKind::automatic), "voxels");
    EXPECT_INPUT_ERROR(method(foreign, GrainsKind::cells), "the file holds no sites; allowed here: auto, voxels");
    EXPECT_TRUE(notices.empty());
    OpalAsset edited = asset;
    edited.grain_id = asset.grain_id->deepCopy();
    openvdb::tools::foreach (edited.grain_id->beginValueOn(),
                             [](const openvdb::Int32Grid::ValueOnIter& value) { value.setValue(1 + *value % 7); });
    EXPECT_EQ(method(edited, GrainsKind::automatic), "voxels");
    ASSERT_EQ(notices.size(), 1u);
    EXPECT_NE(notices[0].find("a.vdb: grain_id is not made of the cells"), std::string::npos);
    EXPECT_EQ(method(edited, GrainsKind::cells), "cells");
    for (Site& site : asset.sites) site.grain = 0;
    EXPECT_EQ(method(asset, GrainsKind::automatic), "voxels");
}

TEST(GrainSource, SameBitsFromAnyNumberOfThreads) {
    const ScratchFolder folder;
    write_opal_asset(colourful().make(), folder / "opal.vdb");
    for (const char* grains : {"cells", "voxels", "sphere-tracing", "hyperboloid"}) {
        const auto render = [&](std::size_t threads) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            return render_text(scene_of(folder / "opal.vdb", fmt::format("[opal]\ngrains = \"{}\"\n", grains)), 4);
        };
        EXPECT_EQ(render(1).image.pixels, render(2).image.pixels) << grains;
    }
}

}  // namespace
}  // namespace opal
