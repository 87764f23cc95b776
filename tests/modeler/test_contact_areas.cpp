// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/contact_areas.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "formats/units.h"
#include "modeler/build.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

ShapeRecipe shape_recipe(ShapeKind kind, const std::array<double, 3>& size_mm) {
    ShapeRecipe recipe;
    recipe.kind = kind;
    recipe.size_mm = size_mm;
    return recipe;
}

TEST(ContactAreas, SquaresOfACubicLattice) {
    const auto shape = make_shape(shape_recipe(ShapeKind::box, {4.0, 4.0, 4.0}));
    std::vector<Site> sites;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            for (int k = 0; k < 4; ++k) sites.push_back({openvdb::Vec3d(i - 1.5, j - 1.5, k + 0.5), 0.25f, 0});
    const NeighbourGraph graph = apollonius_graph(sites, std::vector<char>(64, 0), *shape, 1.0);
    const std::vector<double> areas_mm2 = contact_areas_mm2(graph, sites, *shape);
    for (const double area : areas_mm2) EXPECT_NEAR(area, 1.0, 0.015);
    EXPECT_NEAR(std::accumulate(areas_mm2.begin(), areas_mm2.end(), 0.0), 144.0, 0.005 * 144.0);
}

/// Area of the sheet z = a sqrt(1 + rho^2 / b^2), b^2 = c^2 - a^2, within a ball of radius R about the origin, by Simpson's rule.
double sheet_area_mm2(double a, double c, double radius) {
    const double b2 = c * c - a * a;
    const double end = std::sqrt((radius * radius - a * a) / (1.0 + a * a / b2));
    const auto ring = [&](double rho) {
        const double slope = a * rho / (b2 * std::sqrt(1.0 + rho * rho / b2));
        return 2.0 * units::pi * rho * std::sqrt(1.0 + slope * slope);
    };
    constexpr int steps = 1000;
    double sum = ring(0.0) + ring(end);
    for (int n = 1; n < steps; ++n) sum += (n % 2 == 1 ? 4.0 : 2.0) * ring(end * n / steps);
    return sum * end / (3.0 * steps);
}

TEST(ContactAreas, OfTwoSitesInABall) {
    // A sphere rests on z = 0: its centre is 1 mm up.
    const auto shape = make_shape(shape_recipe(ShapeKind::sphere, {2.0, 2.0, 2.0}));
    for (const float lead_mm : {0.0f, 0.25f, 0.5f}) {
        const std::vector<Site> sites = {{{0.0, 0.0, 0.6}, lead_mm, 0}, {{0.0, 0.0, 1.4}, 0.0f, 0}};
        const std::vector<double> areas_mm2 = contact_areas_mm2({{0, 1}}, sites, *shape);
        const double expected_mm2 = sheet_area_mm2(0.5 * static_cast<double>(lead_mm), 0.4, 1.0);
        EXPECT_NEAR(areas_mm2[0], expected_mm2, 0.02 * expected_mm2) << lead_mm;
    }
    EXPECT_NEAR(sheet_area_mm2(0.0, 0.4, 1.0), units::pi, 1.0e-9);
}

TEST(ContactAreas, DoNotDependOnThreads) {
    const auto shape = make_shape(shape_recipe(ShapeKind::ellipsoid, {6.0, 5.0, 4.0}));
    const std::vector<Site> sites = testing_tools::random_sites(shape->bounds_mm(), 100, 0.1, 2);
    const NeighbourGraph graph = apollonius_graph(sites, std::vector<char>(100, 0), *shape, 1.0);
    const auto measure = [&] { return contact_areas_mm2(graph, sites, *shape); };
    EXPECT_EQ(testing_tools::with_threads(1, measure), testing_tools::with_threads(2, measure));
}

TEST(ContactAreas, SinteringKeepsLargeContactsFirst) {
    const std::string text =
        "[shape]\nkind = \"sphere\"\n[grains]\nnum_sites = 1500\nresolution = 16\n"
        "sintering = { probability = 0.04, preference = \"";
    const auto kept = [&](const std::string& preference) {
        return build_opal(parse_recipe(text + preference + "\" }\n", "r.toml", {}), [](const std::string&) {}).report;
    };
    const BuildReport none = kept("none"), area = kept("area");
    // For small p a bond is kept with p times its area over the mean, so about as many are.
    const double expected = 0.04 * static_cast<double>(none.bonds);
    EXPECT_EQ(none.bonds, area.bonds);
    EXPECT_NEAR(static_cast<double>(area.kept_bonds), expected, 4.0 * std::sqrt(expected) + 0.03 * expected);
    EXPECT_NE(none.largest_grain_fraction, area.largest_grain_fraction);
}

}  // namespace
}  // namespace opal
