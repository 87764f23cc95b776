// SPDX-License-Identifier: Apache-2.0
#include "modeler/grain_statistics.h"

#include <cmath>
#include <numeric>

#include "formats/units.h"
#include "modeler/misorientation.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

/// A grid with a large constant region (tiles), leaves of several grains, and a grain without voxels.
OpalAsset four_grains() {
    OpalAsset asset;
    asset.grain_id = openvdb::Int32Grid::create(0);
    asset.grain_id->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    asset.grain_id->sparseFill(openvdb::CoordBBox({0, 0, 0}, {63, 63, 63}), 1, true);
    asset.grain_id->sparseFill(openvdb::CoordBBox({64, 0, 0}, {70, 4, 3}), 2, true);
    asset.grain_id->sparseFill(openvdb::CoordBBox({3, 3, 3}, {4, 4, 4}), 4, true);
    for (const std::int32_t grain : {1, 1, 2, 4, 3, 1, 0, 1, 1}) asset.sites.push_back({openvdb::Vec3d(0.0), 0.0f, grain});
    for (std::uint64_t g = 1; g <= 4; ++g) asset.grain_orientations.push_back(random_orientation(1, false, g));
    return asset;
}

TEST(GrainStatistics, CountsVoxelsInLeavesAndTiles) {
    const OpalAsset asset = four_grains();
    EXPECT_GT(asset.grain_id->tree().activeTileCount(), 0u);
    const auto count = [&] { return voxels_per_grain(*asset.grain_id, 4); };
    EXPECT_EQ(count(), (std::vector<std::uint64_t>{64 * 64 * 64 - 8, 7 * 5 * 4, 0, 8}));
    EXPECT_EQ(testing_tools::with_threads(1, count), testing_tools::with_threads(2, count));
}

TEST(GrainStatistics, SizesAreThoseOfTheVoxels) {
    const GrainStatistics statistics = grain_statistics(four_grains(), {});
    const double volumes_mm3[3] = {0.125 * (64 * 64 * 64 - 8), 0.125 * 140, 0.125 * 8};
    EXPECT_EQ(statistics.grains_without_voxels, 1u);
    EXPECT_DOUBLE_EQ(statistics.volume_mm3.max, volumes_mm3[0]);
    EXPECT_DOUBLE_EQ(statistics.volume_mm3.median, volumes_mm3[1]);
    EXPECT_DOUBLE_EQ(statistics.volume_mm3.min, volumes_mm3[2]);
    const double mean = (volumes_mm3[0] + volumes_mm3[1] + volumes_mm3[2]) / 3.0;
    EXPECT_NEAR(statistics.volume_mm3.mean, mean, 1e-9);
    double variance = 0.0;
    for (const double volume : volumes_mm3) variance += (volume - mean) * (volume - mean) / 3.0;
    EXPECT_NEAR(statistics.volume_mm3.std, std::sqrt(variance), 1e-9);
    EXPECT_DOUBLE_EQ(statistics.diameter_mm.min, std::cbrt(6.0 / units::pi));
    EXPECT_EQ(statistics.diameter_histogram.count.size(), 20u);
    EXPECT_EQ(statistics.diameter_histogram.count.front(), 1u);
    EXPECT_EQ(statistics.diameter_histogram.count.back(), 1u);
    EXPECT_EQ(std::accumulate(statistics.diameter_histogram.count.begin(), statistics.diameter_histogram.count.end(), 0u), 3u);
    // Sites 5, 1, 1, 1: bins 1, 2 to 3, 4 to 7.
    EXPECT_DOUBLE_EQ(statistics.sites_per_grain.mean, 2.0);
    EXPECT_EQ(statistics.sites_histogram.count, (std::vector<std::uint64_t>{3, 0, 1}));
}

TEST(GrainStatistics, MisorientationsAreOfNeighbouringGrainsOnce) {
    const OpalAsset asset = four_grains();
    // Grain pairs 1-2 (twice), 2-4 and one inside grain 1.
    const GrainStatistics statistics = grain_statistics(asset, {{0, 1}, {0, 2}, {1, 2}, {2, 3}});
    EXPECT_EQ(statistics.neighbouring_grains, 2u);
    const auto& q = asset.grain_orientations;
    const double a = units::deg_from_rad(misorientation_angle_rad(q[0], q[1])),
                 b = units::deg_from_rad(misorientation_angle_rad(q[1], q[3]));
    EXPECT_NEAR(statistics.misorientation_deg.mean, 0.5 * (a + b), 1e-9);
    EXPECT_GE(statistics.misorientation_histogram.count[std::size_t(a / 2.0)], 1u);
    EXPECT_GE(statistics.misorientation_histogram.count[std::size_t(b / 2.0)], 1u);
    EXPECT_NEAR(std::accumulate(statistics.misorientation_expected.begin(), statistics.misorientation_expected.end(), 0.0), 1.0,
                1e-6);
}

TEST(GrainStatistics, OfSitesAloneAndOfNothing) {
    OpalAsset asset = four_grains();
    asset.grain_id = nullptr;
    const nlohmann::json json = grain_statistics_to_json(grain_statistics(asset, {}));
    EXPECT_FALSE(json.contains("volume_mm3"));
    EXPECT_EQ(json["sites_per_grain"]["max"], 5.0);
    EXPECT_EQ(grain_statistics(OpalAsset(), {}).neighbouring_grains, 0u);
}

}  // namespace
}  // namespace opal
