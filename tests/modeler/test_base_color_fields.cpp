// SPDX-License-Identifier: Apache-2.0
#include "modeler/base_color_fields.h"

#include <openvdb/tools/Interpolation.h>

#include <cmath>
#include <set>

#include "formats/field_summary.h"
#include "formats/units.h"
#include "modeler/build.h"
#include "modeler/labelling.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

using testing_tools::input_error_of;
using testing_tools::random_point;

/// Half-axes of the ellipsoid below, which rests on the ground.
const openvdb::Vec3d half_axes_mm(3.0, 2.5, 1.5);

OpalAsset build_with(const std::string& base_color, const std::string& output = "") {
    return build_opal(parse_recipe("[shape]\nkind = \"ellipsoid\"\nsize_mm = [6.0, 5.0, 3.0]\n[grains]\nnum_sites = 60\n"
                                   "voxel_size_mm = 0.08\nseed = 9\nsintering = { probability = 0.0 }\n[base_color]\n" +
                                       base_color + output,
                                   "test.toml", {}),
                      [](const std::string&) {})
        .asset;
}

/// Places uniform in the ellipsoid.
std::vector<openvdb::Vec3d> places_inside(std::size_t count) {
    std::vector<openvdb::Vec3d> places;
    const openvdb::BBoxd box(openvdb::Vec3d(-3.0, -2.5, 0.0), openvdb::Vec3d(3.0, 2.5, 3.0));
    for (std::uint64_t n = 0; places.size() < count; ++n) {
        const openvdb::Vec3d place = random_point(box, 3, n);
        if (((place - openvdb::Vec3d(0.0, 0.0, 1.5)) / half_axes_mm).lengthSqr() < 1.0) places.push_back(place);
    }
    return places;
}

double sampled(const openvdb::FloatGrid& grid, const openvdb::Vec3d& place_mm) {
    return openvdb::tools::BoxSampler::sample(grid.tree(), grid.worldToIndex(place_mm));
}

/// Whether linear interpolation at the place reads active voxels alone.
bool covered(const openvdb::FloatGrid& grid, const openvdb::Vec3d& place_mm) {
    const openvdb::Vec3d index = grid.worldToIndex(place_mm);
    for (const openvdb::Coord& corner :
         openvdb::CoordBBox(openvdb::Coord::floor(index), openvdb::Coord::floor(index).offsetBy(1)))
        if (!grid.tree().isValueOn(corner)) return false;
    return true;
}

TEST(BaseColorFields, LayersFollowTheirSine) {
    const OpalAsset asset = build_with(
        "sigma_s_mie_per_mm = 0.4\nsigma_s_mie_field = { kind = \"layers\", contrast = 0.5, scale_mm = 1.6, "
        "direction = [2.0, 0.0, 0.0] }\n");
    ASSERT_TRUE(asset.sigma_s_mie);
    EXPECT_FALSE(asset.sigma_a_scale);
    EXPECT_FALSE(asset.sigma_s_rayleigh_400nm);
    EXPECT_NEAR(asset.sigma_s_mie->voxelSize().x(), 0.1, 1e-12);  // a sixteenth of the period
    double largest = 0.0;
    for (const openvdb::Vec3d& place : places_inside(20000)) {
        const double exact = 0.4 * (1.0 + 0.5 * std::sin(2.0 * units::pi * place.x() / 1.6));
        largest = std::max(largest, std::abs(sampled(*asset.sigma_s_mie, place) - exact));
    }
    // Linear interpolation of a sine of amplitude 0.2 over steps of 1/16 period: at most 0.2 (pi/16)^2 / 2 off.
    EXPECT_LE(largest, 0.2 * std::pow(units::pi / 16.0, 2) / 2.0 * 1.001);
    EXPECT_GT(largest, 0.0);
}

TEST(BaseColorFields, EveryPlaceInsideIsCoveredAndBounded) {
    const OpalAsset asset = build_with(
        "sigma_a_field = { kind = \"noise\", contrast = 0.8, scale_mm = 2.0, octaves = 2 }\n"
        "sigma_s_rayleigh_400nm_per_mm = 0.3\nsigma_s_rayleigh_field = { kind = \"grains\", contrast = 1.0 }\n"
        "sigma_s_mie_per_mm = 0.2\nsigma_s_mie_field = { kind = \"noise\", contrast = 0.8, scale_mm = 2.0, octaves = 2, "
        "voxel_size_mm = 1.3 }\n");
    ASSERT_TRUE(asset.sigma_a_scale && asset.sigma_s_rayleigh_400nm && asset.sigma_s_mie);
    EXPECT_NEAR(asset.sigma_a_scale->voxelSize().x(), 0.25, 1e-12);  // a quarter of the finer octave's cell of 1 mm
    EXPECT_NEAR(asset.sigma_s_rayleigh_400nm->voxelSize().x(), 0.08, 1e-12);
    EXPECT_NEAR(asset.sigma_s_mie->voxelSize().x(), 1.3, 1e-12);
    for (const openvdb::Vec3d& place : places_inside(50000)) {
        ASSERT_TRUE(covered(*asset.sigma_a_scale, place)) << place;
        ASSERT_TRUE(covered(*asset.sigma_s_rayleigh_400nm, place)) << place;
        ASSERT_TRUE(covered(*asset.sigma_s_mie, place)) << place;
    }
    const FieldSummary scale = summarize_field(*asset.sigma_a_scale, asset.shape);
    EXPECT_GE(scale.min, 0.2f);
    EXPECT_LE(scale.max, 1.8f);
    EXPECT_GT(scale.max - scale.min, 0.4f);
    const FieldSummary rayleigh = summarize_field(*asset.sigma_s_rayleigh_400nm, asset.shape);
    EXPECT_GE(rayleigh.min, 0.0f);
    EXPECT_LE(rayleigh.max, 0.6f);
    // Fields of the same kind are different fields.
    double difference = 0.0;
    for (const openvdb::Vec3d& place : places_inside(200))
        difference =
            std::max(difference, std::abs(sampled(*asset.sigma_a_scale, place) - sampled(*asset.sigma_s_mie, place) / 0.2));
    EXPECT_GT(difference, 0.2);
}

TEST(BaseColorFields, OnlyVoxelsNearTheShapeAreActive) {
    const OpalAsset asset = build_with("sigma_a_field = { kind = \"noise\", voxel_size_mm = 0.2 }\n");
    for (auto value = asset.sigma_a_scale->cbeginValueOn(); value; ++value) {
        const openvdb::Vec3d place = asset.sigma_a_scale->indexToWorld(value.getCoord()) - openvdb::Vec3d(0.0, 0.0, 1.5);
        // Farther out than sqrt(3) voxels of 0.2 mm in every direction.
        ASSERT_LT((place / (half_axes_mm + openvdb::Vec3d(0.36))).length(), 1.0) << place;
    }
    EXPECT_EQ(asset.sigma_a_scale->background(), 0.0f);
}

TEST(BaseColorFields, GrainFactorsAreConstantInEachGrainAndTiled) {
    const OpalAsset asset = build_with("sigma_a_field = { kind = \"grains\", contrast = 0.5 }\n");
    std::vector<float> factor(asset.num_grains() + 1, -1.0f);
    auto values = asset.sigma_a_scale->getConstAccessor();
    for (auto id = asset.grain_id->cbeginValueOn(); id; ++id) {
        const float value = values.getValue(id.getCoord());
        float& seen = factor[std::size_t(*id)];
        if (seen < 0.0f) seen = value;
        ASSERT_EQ(seen, value);
        ASSERT_GE(value, 0.5f);
        ASSERT_LE(value, 1.5f);
    }
    EXPECT_EQ(std::set<float>(factor.begin() + 1, factor.end()).size(), asset.num_grains());
    EXPECT_GT(asset.sigma_a_scale->tree().activeTileCount(), 0u);
    // Mean of 60 uniform factors in [0.5, 1.5]: 1 with a standard error of 1/sqrt(12 * 60) = 0.037.
    double sum = 0.0;
    for (std::size_t g = 1; g < factor.size(); ++g) sum += double(factor[g]);
    EXPECT_NEAR(sum / double(asset.num_grains()), 1.0, 4.0 * 0.0373);
}

TEST(BaseColorFields, WhatDoesNotVaryIsNeverWritten) {
    const OpalAsset still = build_with(
        "sigma_a_field = { kind = \"noise\", contrast = 0.0 }\nsigma_s_mie_field = { kind = \"grains\" }\n"
        "sigma_s_rayleigh_400nm_per_mm = 0.25\nsigma_s_rayleigh_field = { kind = \"constant\" }\n");
    EXPECT_TRUE(varying_coefficients(still).empty());
    EXPECT_NEAR(still.constants.sigma_a_per_mm.at(550.0), 0.25, 1e-12);
    EXPECT_EQ(still.constants.sigma_s_rayleigh_400nm_per_mm, 0.25);
    EXPECT_EQ(still.constants.sigma_s_mie_per_mm, 0.0);
}

class UserFields : public testing::Test {
  protected:
    static std::string write(const openvdb::FloatGrid::Ptr& grid) {
        initialize_openvdb();
        grid->setName("dirt");
        const std::string path = testing_tools::temporary_file("user_field.vdb");
        openvdb::io::File file(path);
        file.write({grid});
        file.close();
        return path;
    }
    static std::string field(const std::string& path, const std::string& more = "") {
        return "sigma_s_mie_per_mm = 0.5\nsigma_s_mie_field = { kind = \"grid\", file = \"" + path + "\"" + more + " }\n";
    }
};

TEST_F(UserFields, AreSampledLinearlyInTheWorld) {
    // 2 + x + 0.5 z in mm, on voxels of 0.3 mm shifted against ours: linear, so interpolation twice over is exact.
    const auto grid = openvdb::FloatGrid::create(1.0f);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.3));
    grid->transform().postTranslate(openvdb::Vec3d(0.11, -0.07, 0.05));
    for (const openvdb::Coord& voxel : openvdb::CoordBBox(openvdb::Coord(-13, -12, -5), openvdb::Coord(13, 12, 15))) {
        const openvdb::Vec3d place = grid->indexToWorld(voxel);
        grid->tree().setValueOn(voxel, float(std::max(0.0, 5.0 + place.x() + 0.5 * place.z())));
    }
    const OpalAsset asset = build_with(field(write(grid)));
    ASSERT_TRUE(asset.sigma_s_mie);
    EXPECT_NEAR(asset.sigma_s_mie->voxelSize().x(), 0.3, 1e-12);
    for (const openvdb::Vec3d& place : places_inside(5000))
        ASSERT_NEAR(sampled(*asset.sigma_s_mie, place), 0.5 * (5.0 + place.x() + 0.5 * place.z()), 1e-5);
}

TEST_F(UserFields, ConstantOnesGoIntoTheCoefficient) {
    const OpalAsset asset = build_with(field(write(openvdb::FloatGrid::create(1.5f))));
    EXPECT_FALSE(asset.sigma_s_mie);
    EXPECT_NEAR(asset.constants.sigma_s_mie_per_mm, 0.75, 1e-7);
}

TEST_F(UserFields, BadOnesAreNamed) {
    const auto negative = openvdb::FloatGrid::create(0.0f);
    negative->tree().setValueOn({1, 2, 3}, -0.1f);
    EXPECT_NE(input_error_of([&] {
                  build_with(field(write(negative)));
              }).find("user_field.vdb: grid 'dirt': voxel [1, 2, 3] holds -0.1; allowed: factors from 0"),
              std::string::npos);
    const auto broken = openvdb::FloatGrid::create(0.0f);
    broken->tree().setValueOn({4, 5, 6}, std::nanf(""));
    EXPECT_NE(input_error_of([&] { build_with(field(write(broken))); }).find("voxel [4, 5, 6] holds nan"), std::string::npos);
    EXPECT_NE(input_error_of([&] {
                  build_with(field(write(openvdb::FloatGrid::create(1.0f)), ", grid = \"drit\""));
              }).find("no float grid named 'drit' (float grids: dirt)"),
              std::string::npos);
    EXPECT_NE(input_error_of([&] {
                  build_with("sigma_a_field = { kind = \"noise\", voxel_size_mm = 0.001 }\n");
              }).find("base_color.sigma_a_field.voxel_size_mm 0.001: would take"),
              std::string::npos);
}

TEST(BaseColorFields, SameBitsOnAnyNumberOfThreads) {
    const std::string color =
        "sigma_a_field = { kind = \"noise\", voxel_size_mm = 0.1 }\nsigma_s_mie_per_mm = 0.2\n"
        "sigma_s_mie_field = { kind = \"grains\" }\n";
    const auto one = testing_tools::with_threads(1, [&] { return build_with(color); });
    const auto two = testing_tools::with_threads(2, [&] { return build_with(color); });
    EXPECT_TRUE(testing_tools::same_grids(*one.sigma_a_scale, *two.sigma_a_scale));
    EXPECT_TRUE(testing_tools::same_grids(*one.sigma_s_mie, *two.sigma_s_mie));
}

TEST(BuildOutput, SitesAloneTakeNoVoxelsWhateverTheirSize) {
    const std::string recipe =
        "[shape]\nkind = \"ellipsoid\"\nsize_mm = [6.0, 5.0, 3.0]\n[grains]\nnum_sites = 200\n[output]\ngrids = [\"sites\"]\n";
    const auto built = [&](const std::string& voxels) {
        return build_opal(parse_recipe(recipe, "test.toml", {"grains." + voxels}), [](const std::string&) {});
    };
    const BuiltOpal fine = built("voxel_size_mm=0.0001"), coarse = built("resolution=64");
    EXPECT_FALSE(fine.asset.grain_id);
    EXPECT_FALSE(fine.asset.shape);
    ASSERT_EQ(fine.asset.sites.size(), 200u);
    for (std::size_t n = 0; n < 200; ++n) {
        EXPECT_EQ(fine.asset.sites[n].position_mm, coarse.asset.sites[n].position_mm);
        EXPECT_EQ(fine.asset.sites[n].grain, coarse.asset.sites[n].grain);
    }
    const nlohmann::json report = report_to_json(fine.report, fine.asset);
    EXPECT_TRUE(report["voxel_size_mm"].is_null());
    // An ellipsoid of 6 x 5 x 3 mm: its grains' mean volume as a ball, the volume being estimated from 10,000 points to 1 %.
    const double exact_mm = std::cbrt(6.0 * 5.0 * 3.0 / double(fine.asset.num_grains()));
    EXPECT_NEAR(report["mean_grain_diameter_mm"].get<double>(), exact_mm, 4.0 * 0.01 / 3.0 * exact_mm);
    EXPECT_NE(report_summary(fine.report, fine.asset).find("no labels: grains are in the sites alone"), std::string::npos);
}

TEST(BuildOutput, SitesThatWereReadBackGiveTheSameLabels) {
    const OpalAsset asset = build_with("");
    const std::string path = testing_tools::temporary_file("read_back.vdb");
    write_opal_asset(asset, path);
    std::vector<std::string> notices;
    const OpalAsset back = read_opal_asset(path, {}, notices);
    std::vector<std::int32_t> grain_of_site;
    for (const Site& site : back.sites) grain_of_site.push_back(site.grain);
    EXPECT_TRUE(testing_tools::same_grids(*label_voxels(back.sites, grain_of_site, *back.shape), *asset.grain_id));
}

TEST(BuildOutput, TwinsNeedGrainIds) {
    EXPECT_NE(input_error_of([] { build_with("", "[output]\ngrids = [\"sites\"]\nfor_blender = true\n"); }).find("for_blender"),
              std::string::npos);
}

}  // namespace
}  // namespace opal
