// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <numeric>

#include "modeler/point_grid.h"
#include "modeler/sample_cells.h"
#include "modeler/sample_elimination.h"
#include "modeler/sites.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

using testing_tools::random_point;

std::unique_ptr<Shape> cabochon() {
    ShapeRecipe recipe;
    recipe.kind = ShapeKind::cabochon;
    recipe.girdle_mm = 0.6;
    return make_shape(recipe);
}

/// A speck in a huge box.
class SpeckShape final : public Shape {
  public:
    double signed_distance_mm(const openvdb::Vec3d& p) const override { return p.length() - 1.0e-3; }
    openvdb::BBoxd bounds_mm() const override { return {openvdb::Vec3d(-1.0), openvdb::Vec3d(1.0)}; }
};

class SiteCount : public ::testing::TestWithParam<std::size_t> {};

TEST_P(SiteCount, IsExactAndInside) {
    const auto shape = cabochon();
    const SiteSet sites = sample_sites(*shape, GetParam(), 3);
    ASSERT_EQ(sites.positions_mm.size(), GetParam());
    for (const openvdb::Vec3d& p : sites.positions_mm) ASSERT_LT(shape->signed_distance_mm(p), 0.0) << p;
}

INSTANTIATE_TEST_SUITE_P(Sites, SiteCount, ::testing::Values(1, 2, 7, 1000, 27000));

TEST(Sites, FormAPoissonDisk) {
    const SiteSet sites = sample_sites(*cabochon(), 1000, 1);
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < sites.positions_mm.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
            shortest = std::min(shortest, (sites.positions_mm[a] - sites.positions_mm[b]).length());
    EXPECT_DOUBLE_EQ(sites.shortest_distance_mm, shortest);
    EXPECT_GT(sites.relative_radius, 0.6);  // uniform points have about 0.05
    EXPECT_LT(sites.relative_radius, 1.0);
}

TEST(Sites, VolumeIsEstimatedFromTheSampling) {
    ShapeRecipe recipe;
    recipe.kind = ShapeKind::sphere;
    recipe.size_mm = {10.0, 10.0, 10.0};
    // 10,000 hits of 19,100 tries: relative standard deviation sqrt((1 - 0.524) / 10,000) = 0.7 %.
    EXPECT_NEAR(sample_sites(*make_shape(recipe), 7, 1).shape_volume_mm3, 523.6, 0.03 * 523.6);
}

TEST(Sites, AreAFunctionOfTheSeedAlone) {
    const auto shape = cabochon();
    const auto one = testing_tools::with_threads(1, [&] { return sample_sites(*shape, 500, 9); });
    const auto two = testing_tools::with_threads(2, [&] { return sample_sites(*shape, 500, 9); });
    EXPECT_EQ(one.positions_mm, two.positions_mm);
    EXPECT_NE(one.positions_mm, sample_sites(*shape, 500, 10).positions_mm);
}

TEST(Sites, SingleSiteHasNoShortestDistance) {
    const SiteSet sites = sample_sites(*cabochon(), 1, 1);
    EXPECT_EQ(sites.shortest_distance_mm, 0.0);
    EXPECT_EQ(sites.relative_radius, 0.0);
}

TEST(Sites, FillABoundingBoxOnRequest) {
    GrainsRecipe grains;
    grains.num_sites = 4000;
    grains.sites.region = SiteRegion::bounds;
    const auto shape = cabochon();
    const SiteSet sites = sample_sites(*shape, grains);
    ASSERT_EQ(sites.positions_mm.size(), 4000u);
    const openvdb::BBoxd bounds = shape->bounds_mm();
    // The part inside the shape is the shape's part of the box; standard deviation at most that of independent points, 0.8 %.
    std::size_t inside = 0;
    for (const openvdb::Vec3d& p : sites.positions_mm) {
        ASSERT_TRUE(bounds.isInside(p)) << p;
        inside += shape->contains(p) ? 1 : 0;
    }
    EXPECT_NEAR(double(inside) / 4000.0, sites.shape_volume_mm3 / bounds.volume(), 0.03);
    EXPECT_DOUBLE_EQ(sites.region_volume_mm3, bounds.volume());
    EXPECT_GT(sites.relative_radius, 0.6);
}

TEST(Sites, ASpeckInAHugeBoxIsSampled) {
    const SiteSet sites = sample_sites(SpeckShape(), 10, 1);
    for (const openvdb::Vec3d& p : sites.positions_mm) EXPECT_LT(p.length(), 1.0e-3);
    EXPECT_NEAR(sites.shape_volume_mm3, 4.18879e-9, 0.03 * 4.18879e-9);
}

/// Promises bounds, holds nothing.
class EmptyShape final : public Shape {
  public:
    double signed_distance_mm(const openvdb::Vec3d& p) const override { return p.length() + 1.0e-3; }
    openvdb::BBoxd bounds_mm() const override { return {openvdb::Vec3d(-1.0), openvdb::Vec3d(1.0)}; }
};

TEST(Sites, ShapeThatHoldsNoPlaceIsRefused) {
    const auto message = testing_tools::input_error_of([] { sample_sites(EmptyShape(), 10, 1); });
    EXPECT_NE(message.find("holds no place for a site"), std::string::npos) << message;
}

TEST(PointGrid, FindsExactlyThePointsWithinARadius) {
    const openvdb::BBoxd box({-3.0, 2.0, 0.0}, {5.0, 2.5, 40.0});
    std::vector<openvdb::Vec3d> points;
    for (std::size_t n = 0; n < 800; ++n) points.push_back(random_point(box, 5, n));
    const PointGrid grid(points, 0.7);
    for (const double radius : {0.3, 0.7, 2.0, 100.0})
        for (std::size_t query = 0; query < 50; ++query) {
            const openvdb::Vec3d centre = random_point({{-5.0, 0.0, -5.0}, {7.0, 4.0, 45.0}}, 6, query);
            std::vector<char> found(points.size(), 0);
            grid.for_each_within(centre, radius, [&](std::size_t index, double) { ++found[index]; });
            for (std::size_t n = 0; n < points.size(); ++n)
                ASSERT_EQ(found[n], (points[n] - centre).lengthSqr() <= radius * radius ? 1 : 0);
        }
}

TEST(SampleElimination, TakesTheMostCrowdedAndTheLowestIndexOfEquals) {
    // A pair at distance 1 and a single point: one of the pair goes, both are equally crowded.
    const std::vector<openvdb::Vec3d> samples = {{0, 0, 0}, {1, 0, 0}, {9, 0, 0}};
    EXPECT_EQ(eliminate_samples(samples, 2, 1.0), (std::vector<std::size_t>{1, 2}));
    EXPECT_EQ(eliminate_samples(samples, 3, 1.0), (std::vector<std::size_t>{0, 1, 2}));
}

/// The definition, literally: crowding summed up anew for every choice.
std::vector<std::size_t> eliminate_one_by_one(const std::vector<openvdb::Vec3d>& samples, std::size_t target, double r_max) {
    const double kept = double(target) / double(samples.size());
    const double nearest = 0.65 * (1.0 - std::pow(kept, 1.5));
    std::vector<std::size_t> alive(samples.size());
    std::iota(alive.begin(), alive.end(), 0);
    while (alive.size() > target) {
        std::size_t most_crowded = 0;
        double highest = -1.0;
        for (std::size_t a = 0; a < alive.size(); ++a) {
            double crowding = 0.0;
            for (const std::size_t b : alive) {
                if (b == alive[a]) continue;
                const double distance = (samples[alive[a]] - samples[b]).length() / (2.0 * r_max);
                if (distance < 1.0) crowding += std::pow(1.0 - std::max(distance, nearest), 8.0);
            }
            if (crowding > highest) {
                highest = crowding;
                most_crowded = a;
            }
        }
        alive.erase(alive.begin() + std::ptrdiff_t(most_crowded));
    }
    return alive;
}

TEST(SampleElimination, IsTheDefinitions) {
    const openvdb::BBoxd box(openvdb::Vec3d(0.0), {1.0, 2.0, 3.0});
    std::vector<openvdb::Vec3d> samples;
    for (std::size_t n = 0; n < 400; ++n) samples.push_back(random_point(box, 21, n));
    for (const std::size_t target : {1, 30, 80, 300, 399, 400})
        EXPECT_EQ(eliminate_samples(samples, target, packing_radius(box.volume(), target)),
                  eliminate_one_by_one(samples, target, packing_radius(box.volume(), target)))
            << target;
    // Far more crowded than meant, with duplicates.
    samples.resize(150);
    samples.insert(samples.end(), samples.begin(), samples.begin() + 50);
    EXPECT_EQ(eliminate_samples(samples, 60, 1.0).size(), 60u);
}

TEST(SampleElimination, DoesNotDependOnThreads) {
    // Enough samples that several threads share the work.
    const openvdb::BBoxd box(openvdb::Vec3d(0.0), openvdb::Vec3d(1.0));
    std::vector<openvdb::Vec3d> samples;
    for (std::size_t n = 0; n < 100'000; ++n) samples.push_back(random_point(box, 22, n));
    const auto thin_out = [&] { return eliminate_samples(samples, 20'000, packing_radius(1.0, 20'000)); };
    const auto one = testing_tools::with_threads(1, thin_out);
    EXPECT_EQ(one.size(), 20'000u);
    EXPECT_EQ(one, testing_tools::with_threads(2, thin_out));
    EXPECT_EQ(one, testing_tools::with_threads(3, thin_out));
}

TEST(ShortestDistance, IsFoundFromAnyGuess) {
    std::vector<openvdb::Vec3d> points = {{0, 0, 0}, {0, 3, 4}, {100, 0, 0}, {100, 7, 0}};
    for (const double guess : {1e-3, 0.1, 5.0, 1e4}) EXPECT_DOUBLE_EQ(shortest_distance(points, guess), 5.0);
    points.push_back(points.back());
    EXPECT_EQ(shortest_distance(points, 1.0), 0.0);
    EXPECT_EQ(shortest_distance({{1, 2, 3}}, 1.0), 0.0);
}

}  // namespace
}  // namespace opal
