// SPDX-License-Identifier: Apache-2.0
#include "modeler/weights.h"

#include <algorithm>
#include <cmath>

#include "modeler/hidden_sites.h"
#include "modeler/weight_field.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

using testing_tools::random_point;
using testing_tools::random_sites;

struct Weighed {
    SiteSet sites;
    WeighedSites weighed;

    double weight(std::size_t n) const { return double(weighed.sites[n].weight_mm); }
    double shortest_mm() const { return sites.shortest_distance_mm; }
};

/// Sites in an ellipsoid, with the weights of a [grains] table.
Weighed weigh(const std::string& grains, std::size_t count = 800) {
    const Recipe recipe = parse_recipe("[shape]\nkind = \"ellipsoid\"\n[grains]\n" + grains, "test.toml", {});
    const auto shape = make_shape(recipe.shape);
    Weighed result{sample_sites(*shape, count, 2), {}};
    result.weighed = weigh_sites(result.sites, recipe.grains, *shape);
    return result;
}

std::pair<double, double> weight_range(const Weighed& weighed) {
    double low = 1.0e30, high = -1.0e30;
    for (const Site& site : weighed.weighed.sites) {
        low = std::min(low, double(site.weight_mm));
        high = std::max(high, double(site.weight_mm));
    }
    return {low, high};
}

std::string error_of(const std::string& grains) {
    return testing_tools::input_error_of([&] { weigh(grains, 20); });
}

TEST(Weights, NoisesKeepTheConditionOfVisibleSites) {
    for (const std::string kind : {"perlin", "simplex"}) {
        const Weighed weighed = weigh("weight = { kind = \"" + kind + "\", amplitude = 0.5, scale_mm = 1.5 }");
        const auto [least, most] = weight_range(weighed);
        EXPECT_LE(most - least, weighed.shortest_mm());
        EXPECT_GT(most - least, 0.3 * weighed.shortest_mm());
        EXPECT_EQ(weighed.weighed.weight_scale, 1.0);
        const std::vector<char> hidden = find_hidden_sites(weighed.weighed.sites);
        EXPECT_EQ(std::count(hidden.begin(), hidden.end(), 1), 0);
    }
}

TEST(Weights, VoronoiAndNoneAreZero) {
    for (const char* grains : {"tessellation = \"voronoi\"", "weight = { kind = \"none\" }"})
        for (const Site& site : weigh(grains, 20).weighed.sites) EXPECT_EQ(site.weight_mm, 0.0f);
}

TEST(Weights, LinearGrowsAlongItsDirection) {
    const Weighed weighed = weigh("weight = { kind = \"linear\", amplitude = 0.25, direction = [1, 0, 2] }");
    const openvdb::Vec3d direction = openvdb::Vec3d(1, 0, 2).unit();
    const auto [least, most] = weight_range(weighed);
    EXPECT_NEAR(least, -0.25 * weighed.shortest_mm(), 1e-7);
    EXPECT_NEAR(most, 0.25 * weighed.shortest_mm(), 1e-7);
    const auto along = [&](std::size_t n) { return direction.dot(weighed.sites.positions_mm[n]); };
    const double slope = (weighed.weight(1) - weighed.weight(0)) / (along(1) - along(0));
    EXPECT_GT(slope, 0.0);
    for (std::size_t n = 2; n < 800; ++n) ASSERT_NEAR(weighed.weight(n), weighed.weight(0) + slope * (along(n) - along(0)), 1e-6);
}

TEST(Weights, RadialGrowsWithTheDistanceFromItsCentre) {
    const Weighed weighed = weigh("weight = { kind = \"radial\", amplitude = 0.25, center_mm = [3, 0, 1] }");
    const auto [least, most] = weight_range(weighed);
    EXPECT_NEAR(least, -0.25 * weighed.shortest_mm(), 1e-7);
    EXPECT_NEAR(most, 0.25 * weighed.shortest_mm(), 1e-7);
    const auto away = [&](std::size_t n) { return (weighed.sites.positions_mm[n] - openvdb::Vec3d(3, 0, 1)).length(); };
    const double slope = (weighed.weight(1) - weighed.weight(0)) / (away(1) - away(0));
    EXPECT_GT(slope, 0.0);
    for (std::size_t n = 2; n < 800; ++n) ASSERT_NEAR(weighed.weight(n), weighed.weight(0) + slope * (away(n) - away(0)), 1e-6);
}

TEST(Weights, DistanceGrowsWithDepth) {
    const Weighed weighed = weigh("weight = { kind = \"distance\", amplitude = 0.25 }");
    const auto shape = make_shape(ShapeRecipe());
    double deepest = 0.0;
    for (const openvdb::Vec3d& place : weighed.sites.positions_mm) deepest = std::max(deepest, -shape->signed_distance_mm(place));
    for (std::size_t n = 0; n < 800; ++n) {
        const double depth = -shape->signed_distance_mm(weighed.sites.positions_mm[n]);
        ASSERT_NEAR(weighed.weight(n), 0.25 * weighed.shortest_mm() * (2.0 * depth / deepest - 1.0), 1e-7);
    }
}

/// The values x + 2 y - z + 0.5, which linear interpolation reproduces, on a grid whose voxels lie off the origin.
std::string linear_grid_file() {
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("density");
    const auto transform = openvdb::math::Transform::createLinearTransform(0.5);
    transform->postTranslate({0.2, 0.1, 0.3});
    grid->setTransform(transform);
    auto accessor = grid->getAccessor();
    for (const openvdb::Coord& voxel : openvdb::CoordBBox({-20, -20, -5}, {20, 20, 20})) {
        const openvdb::Vec3d x = grid->indexToWorld(voxel);
        accessor.setValue(voxel, float(0.01 * (x.x() + 2.0 * x.y() - x.z() + 0.5)));
    }
    const auto other = openvdb::FloatGrid::create(3.0f);
    other->setName("other");
    const std::string path = testing_tools::temporary_file("weight_grid.vdb");
    openvdb::io::File(path).write(openvdb::GridPtrVec{grid, other});
    return path;
}

TEST(Weights, GridValuesAreMillimetresInterpolatedInTheWorld) {
    const std::string file = linear_grid_file();
    const Weighed weighed = weigh("limit_weights = false\nweight = { kind = \"grid\", amplitude = 3.0, file = \"" + file +
                                  "\", grid = \"density\" }");
    for (std::size_t n = 0; n < 800; ++n) {
        const openvdb::Vec3d x = weighed.sites.positions_mm[n];
        ASSERT_NEAR(weighed.weight(n), 0.03 * (x.x() + 2.0 * x.y() - x.z() + 0.5), 1e-6);
    }
    const std::string start = "weight = { kind = \"grid\", file = \"" + file + "\"";
    EXPECT_NE(error_of(start + " }").find("must say which float grid to take (float grids: density, other)"), std::string::npos);
    EXPECT_NE(error_of(start + ", grid = \"densty\" }").find("did you mean 'density'"), std::string::npos);
    EXPECT_NE(error_of("weight = { kind = \"grid\", file = \"/nowhere.vdb\" }").find("no such file"), std::string::npos);
}

TEST(Weights, CsvHoldsOneNumberPerSite) {
    std::string text = "weight_mm\n# twenty of them\n";
    for (int n = 0; n < 20; ++n) text += std::to_string(0.01 * n) + "\r\n";
    const auto from = [](const std::string& content) {
        return "limit_weights = false\nweight = { kind = \"csv\", amplitude = 2.0, file = \"" +
               testing_tools::write_test_file("weights.csv", content) + "\" }";
    };
    const Weighed weighed = weigh(from(text), 20);
    for (std::size_t n = 0; n < 20; ++n) EXPECT_FLOAT_EQ(weighed.weighed.sites[n].weight_mm, float(0.02 * double(n)));
    EXPECT_NE(error_of(from(text + "0.5\n")).find("21 values for 20 sites"), std::string::npos);
    EXPECT_NE(error_of(from("1\n2\nx\n")).find("weights.csv:3: expected one finite number, found 'x'"), std::string::npos);
    EXPECT_NE(error_of(from("1\n2, 3\n")).find("weights.csv:2: expected one finite number"), std::string::npos);
    EXPECT_NE(error_of(from("1 2\n")).find("weights.csv:1: expected one finite number"), std::string::npos);
    EXPECT_NE(error_of(from("nan\n")).find("weights.csv:1: expected one finite number"), std::string::npos);
}

TEST(Weights, TermsAddUpAndEqualNoisesDiffer) {
    const std::string linear = "{ kind = \"linear\", amplitude = 0.2 }", noise = "{ kind = \"perlin\", amplitude = 0.1 }";
    const Weighed first = weigh("weight = [" + linear + "]", 50), second = weigh("weight = [" + noise + "]", 50);
    const Weighed sum = weigh("weight = [" + noise + ", " + linear + "]", 50);
    for (std::size_t n = 0; n < 50; ++n) ASSERT_NEAR(sum.weight(n), first.weight(n) + second.weight(n), 1e-6);
    const Weighed twice = weigh("weight = [" + noise + ", " + noise + "]", 50);
    double difference = 0.0;
    for (std::size_t n = 0; n < 50; ++n) difference = std::max(difference, std::abs(twice.weight(n) - 2.0 * second.weight(n)));
    EXPECT_GT(difference, 0.01 * twice.shortest_mm());
}

TEST(Weights, AreLimitedUnlessToldOtherwise) {
    const std::string strong = "weight = { kind = \"perlin\", amplitude = 20.0, scale_mm = 1.0 }\n";
    const Weighed limited = weigh(strong), left_alone = weigh(strong + "limit_weights = false\n");
    EXPECT_EQ(left_alone.weighed.weight_scale, 1.0);
    const double scale = limited.weighed.weight_scale;
    EXPECT_LT(scale, 0.2);
    double largest = 0.0;
    for (std::size_t i = 0; i < 800; ++i) {
        ASSERT_NEAR(limited.weight(i), scale * left_alone.weight(i), 1e-6);
        for (std::size_t j = 0; j < i; ++j)
            if ((limited.sites.positions_mm[i] - limited.sites.positions_mm[j]).length() < 2.0 * limited.sites.spacing_mm())
                largest = std::max(largest, std::abs(limited.weight(i) - limited.weight(j)));
    }
    EXPECT_LT(largest, limited.shortest_mm());
    EXPECT_GT(largest, 0.9999 * limited.shortest_mm());
    const auto hidden = [](const Weighed& weighed) {
        const std::vector<char> marks = find_hidden_sites(weighed.weighed.sites);
        return std::count(marks.begin(), marks.end(), 1);
    };
    EXPECT_EQ(hidden(limited), 0);
    EXPECT_GT(hidden(left_alone), 100);
}

TEST(Weights, FactorsAreSmallerWhereTheFieldIsLarger) {
    const Weighed weighed = weigh("tessellation = \"multiplicative\"\nweight = { kind = \"linear\", amplitude = 2.0 }");
    const auto [least, most] = weight_range(weighed);
    EXPECT_NEAR(least, std::exp(-2.0), 1e-6);
    EXPECT_NEAR(most, std::exp(2.0), 1e-5);
    const std::size_t top = std::size_t(std::max_element(weighed.sites.positions_mm.begin(), weighed.sites.positions_mm.end(),
                                                         [](const auto& a, const auto& b) { return a.z() < b.z(); }) -
                                        weighed.sites.positions_mm.begin());
    EXPECT_EQ(weighed.weight(top), least);
    EXPECT_NE(
        error_of("tessellation = \"multiplicative\"\nweight = { kind = \"linear\", amplitude = 100.0 }").find("exponential"),
        std::string::npos);
}

TEST(Weights, NoiseFinerThanTheShapeAllowsIsRefused) {
    const SiteSet sites = sample_sites(*make_shape(ShapeRecipe()), 20, 2);
    GrainsRecipe recipe;
    recipe.weight[0].scale_mm = 1.0e-320;
    EXPECT_NE(testing_tools::input_error_of([&] { WeightField(recipe, sites, *make_shape(ShapeRecipe())); }).find("scale_mm"),
              std::string::npos);
}

TEST(WeightGrid, HoldsTheFieldAroundTheShape) {
    const Recipe recipe = parse_recipe(
        "[shape]\nkind = \"ellipsoid\"\n[grains]\nweight = { kind = \"perlin\", amplitude = 2.0, octaves = 2 }", "test.toml", {});
    const auto shape = make_shape(recipe.shape);
    const SiteSet sites = sample_sites(*shape, 300, 2);
    const WeightField field(recipe.grains, sites, *shape);
    const auto grid = make_weight_grid(sites, recipe.grains, *shape, 0.25);
    EXPECT_DOUBLE_EQ(grid->voxelSize().x(), 0.25 * 1.5);
    for (auto value = grid->cbeginValueOn(); value; ++value) {
        const openvdb::Vec3d x = grid->indexToWorld(value.getCoord());
        ASSERT_FLOAT_EQ(*value, float(0.25 * field.at(x)));
        ASSERT_LE(shape->signed_distance_mm(x), std::sqrt(3.0) * 0.376);
    }
    for (const openvdb::Vec3d& x : sites.positions_mm)
        ASSERT_TRUE(grid->tree().isValueOn(openvdb::Coord::floor(grid->worldToIndex(x))));
    GrainsRecipe none;
    none.weight[0].kind = WeightKind::none;
    EXPECT_FALSE(make_weight_grid(sites, none, *shape, 1.0));
}

TEST(WeightGrid, OfNumbersPerSiteTakesTheNearest) {
    std::string text;
    for (int n = 0; n < 30; ++n) text += std::to_string(n) + "\n";
    const Recipe recipe = parse_recipe("[shape]\nkind = \"ellipsoid\"\n[grains]\nweight = { kind = \"csv\", file = \"" +
                                           testing_tools::write_test_file("thirty.csv", text) + "\" }",
                                       "test.toml", {});
    const auto shape = make_shape(recipe.shape);
    const SiteSet sites = sample_sites(*shape, 30, 2);
    const WeightField field(recipe.grains, sites, *shape);
    for (std::uint64_t n = 0; n < 300; ++n) {
        const openvdb::Vec3d x = random_point({openvdb::Vec3d(-20.0), openvdb::Vec3d(20.0)}, 3, n);
        const auto nearest =
            std::min_element(sites.positions_mm.begin(), sites.positions_mm.end(),
                             [&](const auto& a, const auto& b) { return (a - x).lengthSqr() < (b - x).lengthSqr(); });
        ASSERT_EQ(field.at(x), double(nearest - sites.positions_mm.begin()));
    }
}

TEST(HiddenSites, EqualASearchThroughAllPairs) {
    const openvdb::BBoxd box(openvdb::Vec3d(0.0), openvdb::Vec3d(10.0));
    for (const double spread : {0.3, 1.0, 5.0}) {
        const std::vector<Site> sites = random_sites(box, 600, spread, 4);
        const std::vector<char> hidden = find_hidden_sites(sites);
        for (std::size_t i = 0; i < sites.size(); ++i) {
            const bool expected = std::any_of(sites.begin(), sites.end(), [&](const Site& other) {
                return &other != &sites[i] && double(other.weight_mm) - double(sites[i].weight_mm) >=
                                                  (other.position_mm - sites[i].position_mm).length();
            });
            ASSERT_EQ(hidden[i] != 0, expected);
        }
    }
}

TEST(HiddenSites, OfTheManhattanMetricEqualASearchThroughAllPairs) {
    const std::vector<Site> sites = random_sites({openvdb::Vec3d(0.0), openvdb::Vec3d(10.0)}, 600, 1.0, 4);
    const std::vector<char> hidden = find_hidden_sites(sites, TessellationKind::manhattan);
    std::size_t count = 0;
    for (std::size_t i = 0; i < sites.size(); ++i) {
        const bool expected = std::any_of(sites.begin(), sites.end(), [&](const Site& other) {
            const openvdb::Vec3d away = other.position_mm - sites[i].position_mm;
            return &other != &sites[i] && double(other.weight_mm) - double(sites[i].weight_mm) >=
                                              std::abs(away.x()) + std::abs(away.y()) + std::abs(away.z());
        });
        ASSERT_EQ(hidden[i] != 0, expected);
        count += expected ? 1 : 0;
    }
    EXPECT_GT(count, 50u);
    EXPECT_LT(count, 550u);
}

TEST(HiddenSites, FactorsHideOnlyInTheSamePlace) {
    std::vector<Site> sites(4);
    for (std::size_t n = 0; n < 4; ++n) sites[n].weight_mm = float(n + 1);
    sites[3].position_mm = {1.0e-9, 0.0, 0.0};
    EXPECT_EQ(find_hidden_sites(sites, TessellationKind::multiplicative), (std::vector<char>{0, 1, 1, 0}));
    sites[2].weight_mm = 0.5f;
    sites[1].weight_mm = 0.5f;
    EXPECT_EQ(find_hidden_sites(sites, TessellationKind::multiplicative), (std::vector<char>{1, 0, 1, 0}));
}

TEST(HiddenSites, OfTwinsTheFirstOwns) {
    std::vector<Site> sites(3);
    sites[2].position_mm = {2.0, 0.0, 0.0};
    sites[2].weight_mm = -2.0f;  // exactly on the limit: owns a ray, which is nothing
    EXPECT_EQ(find_hidden_sites(sites), (std::vector<char>{0, 1, 1}));
}

}  // namespace
}  // namespace opal
