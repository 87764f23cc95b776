// SPDX-License-Identifier: Apache-2.0
#include "modeler/weights.h"

#include <algorithm>
#include <cmath>

#include "modeler/gradient_noise.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

using testing_tools::random_point;
using testing_tools::random_sites;

TEST(Noise, StaysInBoundsAndUsesThem) {
    const openvdb::BBoxd box(openvdb::Vec3d(-50.0), openvdb::Vec3d(50.0));
    for (const int octaves : {1, 4}) {
        double lowest = 0.0, highest = 0.0, sum = 0.0;
        constexpr int count = 20'000;
        for (int n = 0; n < count; ++n) {
            const double value = fractal_noise(random_point(box, 1, std::uint64_t(n)), 42, octaves);
            lowest = std::min(lowest, value);
            highest = std::max(highest, value);
            sum += value;
        }
        EXPECT_GE(lowest, -1.0);
        EXPECT_LE(highest, 1.0);
        EXPECT_LT(lowest, -0.4);
        EXPECT_GT(highest, 0.4);
        EXPECT_NEAR(sum / count, 0.0, 0.02);
    }
}

TEST(Noise, IsZeroOnItsLatticeAndSmoothAcrossCells) {
    for (int n = -3; n <= 3; ++n) EXPECT_EQ(gradient_noise(openvdb::Vec3d(n, 2 - n, 5), 1, 0), 0.0);
    const double step = 1.0e-6;
    for (const double y : {0.3, 0.8}) {
        const double below = gradient_noise({2.0 - step, y, 0.4}, 1, 0), at = gradient_noise({2.0, y, 0.4}, 1, 0);
        const double above = gradient_noise({2.0 + step, y, 0.4}, 1, 0);
        EXPECT_NEAR((above - at) / step, (at - below) / step, 1e-4);
    }
}

TEST(Weights, KeepTheConditionOfVisibleSites) {
    ShapeRecipe shape;
    const SiteSet sites = sample_sites(*make_shape(shape), 800, 2);
    GrainsRecipe recipe;
    recipe.weight[0].amplitude = 0.5;
    recipe.weight[0].scale_mm = 1.5;
    const std::vector<Site> weighed = weigh_sites(sites, recipe);
    const auto [least, most] = std::minmax_element(weighed.begin(), weighed.end(),
                                                   [](const Site& a, const Site& b) { return a.weight_mm < b.weight_mm; });
    EXPECT_LE(most->weight_mm - least->weight_mm, sites.shortest_distance_mm);
    EXPECT_GT(most->weight_mm - least->weight_mm, 0.3 * sites.shortest_distance_mm);
    const std::vector<char> hidden = find_hidden_sites(weighed, sites.spacing_mm());
    EXPECT_EQ(std::count(hidden.begin(), hidden.end(), 1), 0);
}

TEST(Weights, VoronoiAndNoneAreZero) {
    const SiteSet sites = sample_sites(*make_shape(ShapeRecipe()), 20, 2);
    GrainsRecipe voronoi, none;
    voronoi.tessellation = TessellationKind::voronoi;
    none.weight[0].kind = WeightKind::none;
    for (const GrainsRecipe& recipe : {voronoi, none})
        for (const Site& site : weigh_sites(sites, recipe)) EXPECT_EQ(site.weight_mm, 0.0f);
}

TEST(Weights, NoiseScaleThatOverflowsIsRefused) {
    const SiteSet sites = sample_sites(*make_shape(ShapeRecipe()), 20, 2);
    GrainsRecipe recipe;
    recipe.weight[0].scale_mm = 1.0e-320;
    EXPECT_NE(testing_tools::input_error_of([&] { weigh_sites(sites, recipe); }).find("scale_mm"), std::string::npos);
}

TEST(HiddenSites, EqualASearchThroughAllPairs) {
    const openvdb::BBoxd box(openvdb::Vec3d(0.0), openvdb::Vec3d(10.0));
    for (const double spread : {0.3, 1.0, 5.0}) {
        const std::vector<Site> sites = random_sites(box, 600, spread, 4);
        const std::vector<char> hidden = find_hidden_sites(sites, 1.2);
        for (std::size_t i = 0; i < sites.size(); ++i) {
            const bool expected = std::any_of(sites.begin(), sites.end(), [&](const Site& other) {
                return &other != &sites[i] && double(other.weight_mm) - double(sites[i].weight_mm) >=
                                                  (other.position_mm - sites[i].position_mm).length();
            });
            ASSERT_EQ(hidden[i] != 0, expected);
        }
    }
}

TEST(HiddenSites, OfTwinsTheFirstOwns) {
    std::vector<Site> sites(3);
    sites[2].position_mm = {2.0, 0.0, 0.0};
    sites[2].weight_mm = -2.0f;  // exactly on the limit: owns a ray, which is nothing
    EXPECT_EQ(find_hidden_sites(sites, 1.0), (std::vector<char>{0, 1, 1}));
}

}  // namespace
}  // namespace opal
