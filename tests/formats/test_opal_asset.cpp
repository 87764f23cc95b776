// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <sstream>

#include "expect_error.h"
#include "formats/opal_asset_io.h"
#include "opal_asset_fixture.h"

namespace opal {
namespace {

TEST_F(OpalAssetTest, BezierPatchesSurviveARoundTrip) {
    OpalAsset asset = two_grain_ball();
    BezierPatch patch{};
    patch.part = 2;
    patch.control_mm[3][1][0] = 1.0 / 3.0;
    asset.bezier_patches = {patch};
    write_opal_asset(asset, folder_ / "patches.vdb");
    const OpalAsset back = read(folder_ / "patches.vdb");
    ASSERT_EQ(back.bezier_patches.size(), 1u);
    EXPECT_EQ(back.bezier_patches[0].part, 2);
    EXPECT_EQ(back.bezier_patches[0].control_mm[3][1][0], 1.0 / 3.0);
}

TEST_F(OpalAssetTest, RoundTripKeepsEverything) {
    const OpalAsset asset = two_grain_ball();
    write_opal_asset(asset, folder_ / "a.vdb");
    const OpalAsset back = read(folder_ / "a.vdb");
    EXPECT_TRUE(notices_.empty());
    EXPECT_EQ(back.schema_version, opal_schema_version);
    EXPECT_EQ(back.seed, 3u);
    EXPECT_EQ(back.recipe_toml, asset.recipe_toml);
    EXPECT_EQ(back.constants.sigma_a_per_mm.value, asset.constants.sigma_a_per_mm.value);
    ASSERT_EQ(back.sites.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(back.sites[i].position_mm, asset.sites[i].position_mm);
        EXPECT_EQ(back.sites[i].weight_mm, asset.sites[i].weight_mm);
        EXPECT_EQ(back.sites[i].grain, asset.sites[i].grain);
    }
    for (std::size_t g = 0; g < 2; ++g)
        for (int c = 0; c < 4; ++c) EXPECT_EQ(back.grain_orientations[g][c], asset.grain_orientations[g][c]);
    for (auto value = asset.grain_id->cbeginValueOn(); value; ++value)
        ASSERT_EQ(back.grain_id->tree().getValue(value.getCoord()), *value);
    const AssetCheck check = check_opal_asset(folder_ / "a.vdb");
    EXPECT_TRUE(check.errors.empty()) << check.errors.front();
}

TEST_F(OpalAssetTest, PointsAreLast) {
    write_opal_asset(two_grain_ball(), folder_ / "a.vdb");
    const RawOpalFile raw = read_raw_opal_file(folder_ / "a.vdb");
    ASSERT_EQ(raw.grids.size(), 3u);
    EXPECT_EQ(raw.grids[0]->getName(), "grain_id");
    EXPECT_EQ(raw.grids[1]->getName(), "shape");
    EXPECT_EQ(raw.grids[2]->getName(), "sites");
}

TEST_F(OpalAssetTest, MissingForeignAndTruncatedFilesAreNamed) {
    EXPECT_INPUT_ERROR(read("nothing.vdb"), "nothing.vdb: no such file");
    std::ofstream(folder_ / "text.vdb") << "this is not a vdb file at all";
    EXPECT_INPUT_ERROR(read(folder_ / "text.vdb"), "text.vdb: not a complete .vdb file");
    std::ofstream(folder_ / "empty.vdb").close();
    EXPECT_INPUT_ERROR(read(folder_ / "empty.vdb"), "not a complete .vdb file");

    write_opal_asset(two_grain_ball(), folder_ / "a.vdb");
    std::ostringstream bytes;
    bytes << std::ifstream(folder_ / "a.vdb", std::ios::binary).rdbuf();
    const std::string whole = bytes.str();
    for (const double fraction : {0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.98, 0.999}) {
        std::ofstream(folder_ / "cut.vdb", std::ios::binary) << whole.substr(0, std::size_t(fraction * double(whole.size())));
        EXPECT_INPUT_ERROR(read(folder_ / "cut.vdb"), "cut.vdb: not a complete .vdb file");
    }
}

TEST_F(OpalAssetTest, WithoutGrainIdsTheGridsFoundAreNamed) {
    write_foreign(folder_ / "fog.vdb", openvdb::FloatGrid::create(0.0f), "density");
    EXPECT_INPUT_ERROR(read(folder_ / "fog.vdb"), "no grid named grain_id (found: density)");
}

TEST_F(OpalAssetTest, ForeignLabelsReadWithNotices) {
    write_foreign(folder_ / "ids.vdb", two_grain_ball().grain_id, "grain_id");
    const OpalAsset asset = read(folder_ / "ids.vdb");
    EXPECT_EQ(asset.num_grains(), 2u);
    EXPECT_EQ(notices_.size(), 3u);
    EXPECT_TRUE(asset.shape);

    auto floats = openvdb::FloatGrid::create(0.0f);
    floats->tree().setValueOn({0, 0, 0}, 1.0f);
    floats->tree().setValueOn({1, 0, 0}, 2.0f);
    write_foreign(folder_ / "floats.vdb", floats, "grain_id");
    EXPECT_EQ(read(folder_ / "floats.vdb").num_grains(), 2u);
}

TEST_F(OpalAssetTest, WhatLiesOutsideIsEmptied) {
    // Ids left in the background and in inactive voxels, zeros left active: what other programs may write.
    auto ids = openvdb::Int32Grid::create(900000);
    ids->tree().setValueOn({0, 0, 0}, 1);
    ids->tree().setValueOn({1, 0, 0}, 2);
    ids->tree().setValueOn({2, 0, 0}, 0);
    ids->tree().setValueOff({3, 0, 0}, 77);
    write_foreign(folder_ / "dirty.vdb", ids, "grain_id");
    const OpalAsset asset = read(folder_ / "dirty.vdb");
    EXPECT_EQ(asset.num_grains(), 2u);
    EXPECT_EQ(asset.grain_id->activeVoxelCount(), 2u);
    for (const openvdb::Coord outside :
         {openvdb::Coord(2, 0, 0), openvdb::Coord(3, 0, 0), openvdb::Coord(5, 5, 5), openvdb::Coord(5000, 0, 0)})
        EXPECT_EQ(asset.grain_id->tree().getValue(outside), 0);
}

TEST_F(OpalAssetTest, ReSavedWithoutSitesKeepsItsOrientations) {
    OpalAsset asset = two_grain_ball();
    write_opal_asset(asset, folder_ / "whole.vdb");
    RawOpalFile raw = read_raw_opal_file(folder_ / "whole.vdb");
    raw.grids.pop_back();
    const OpalAsset back = asset_from_raw(raw, "resaved.vdb", {}, notices_);
    for (std::size_t g = 0; g < 2; ++g)
        for (int c = 0; c < 4; ++c) EXPECT_EQ(back.grain_orientations[g][c], asset.grain_orientations[g][c]);
}

TEST_F(OpalAssetTest, BrokenShapesAndSparseIdsAreNamed) {
    OpalAsset asset = two_grain_ball();
    asset.shape->tree().setValueOn({20, 0, 0}, std::nanf(""));
    write_opal_asset(asset, folder_ / "nan_shape.vdb");
    EXPECT_INPUT_ERROR(read(folder_ / "nan_shape.vdb"), "grid shape: voxel [20, 0, 0] holds nan");
    auto ids = openvdb::Int32Grid::create(0);
    ids->tree().setValueOn({0, 0, 0}, 1900000000);
    write_foreign(folder_ / "hashed.vdb", ids, "grain_id");
    EXPECT_INPUT_ERROR(read(folder_ / "hashed.vdb"), "holds id 1900000000; allowed: ids up to");
}

TEST_F(OpalAssetTest, BrokenIdsAreNamedByVoxel) {
    auto ids = openvdb::Int32Grid::create(0);
    ids->tree().setValueOn({4, 5, 6}, -3);
    write_foreign(folder_ / "negative.vdb", ids, "grain_id");
    EXPECT_INPUT_ERROR(read(folder_ / "negative.vdb"), "grid grain_id: voxel [4, 5, 6] holds -3");
    auto floats = openvdb::FloatGrid::create(0.0f);
    floats->tree().setValueOn({1, 2, 3}, std::nanf(""));
    write_foreign(folder_ / "nan.vdb", floats, "grain_id");
    EXPECT_INPUT_ERROR(read(folder_ / "nan.vdb"), "voxel [1, 2, 3] holds nan");
    write_foreign(folder_ / "none.vdb", openvdb::Int32Grid::create(0), "grain_id");
    EXPECT_INPUT_ERROR(read(folder_ / "none.vdb"), "no voxel holds a grain");
}

TEST_F(OpalAssetTest, CheckReportsVoxelsOutsideTheShape) {
    OpalAsset asset = two_grain_ball();
    asset.grain_id->tree().setValueOn({35, 0, 0}, 1);
    write_opal_asset(asset, folder_ / "outside.vdb");
    const AssetCheck check = check_opal_asset(folder_ / "outside.vdb");
    ASSERT_EQ(check.errors.size(), 1u);
    EXPECT_NE(check.errors[0].find("1 voxels lie outside the shape"), std::string::npos);
}

TEST_F(OpalAssetTest, RandomOrientationsAreUniform) {
    // Mean of the rotation matrix's trace is 0 for uniform rotations, variance of the trace 1 (Diaconis & Shahshahani: moments of
    // SO(3)).
    const int n = 20000;
    double sum = 0.0, square_sum = 0.0;
    for (int g = 1; g <= n; ++g) {
        const auto q = random_orientation(1, false, std::uint64_t(g));
        const double trace = 4.0 * double(q[3]) * double(q[3]) - 1.0;
        sum += trace;
        square_sum += trace * trace;
    }
    EXPECT_NEAR(sum / n, 0.0, 4.0 / std::sqrt(double(n)));
    EXPECT_NEAR(square_sum / n, 1.0, 4.0 * 1.5 / std::sqrt(double(n)));
}

}  // namespace
}  // namespace opal
