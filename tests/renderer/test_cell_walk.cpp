// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "cell_oracle.h"
#include "cell_samples.h"
#include "renderer/core/cell_walk.h"
#include "renderer/core/grain_path.h"
#include "renderer/core/hyperboloid_walk.h"
#include "renderer/core/sphere_tracing_walk.h"

namespace opal {
namespace {

using namespace cell_samples;

/// The walk's own tolerance is 1e-5 mm at coordinates of 10 mm; two of its decisions, and rounding of places, add up.
constexpr double excess_limit_mm = 6.0e-5;

/// Where the walk differs from the oracle, the two differ by rounding alone, and hardly anywhere.
void expect_exact(const WalkErrors& errors, double limit_mm = excess_limit_mm) {
    EXPECT_GT(errors.crossings, 100u);
    EXPECT_LE(errors.largest_excess_mm, limit_mm);
    EXPECT_LE(errors.wrong_mm, 1.0e-4 * errors.length_mm);
    EXPECT_LE(errors.missed, errors.crossings / 1000 + 1);
    EXPECT_LE(errors.spurious, errors.crossings / 1000 + 1);
}

TEST(CellWalk, EqualsTheOracleOnRandomSites) {
    expect_exact(errors_of<CellWalk>(random_sites(300, 0.0, 1), 100, 2));  // Voronoi
    expect_exact(errors_of<CellWalk>(random_sites(300, 0.7, 3), 100, 4));  // additive
    expect_exact(errors_of<CellWalk>(random_sites(400, 3.0, 5), 100, 6));  // many hidden
    expect_exact(errors_of<CellWalk>(random_sites(12, 4.0, 7), 400, 8));   // few, large, strongly curved
}

TEST(CellWalk, EqualsTheOracleOnNearlyEqualWeights) {
    for (const double spread_mm : {1.0e-2, 1.0e-4, 1.0e-6, 1.0e-8})
        expect_exact(errors_of<CellWalk>(random_sites(200, spread_mm, 11), 40, 12));
}

/// As rays that slip through a body's surface ask: far from the sites rounding would let a walk go to and fro for ever.
TEST(GrainPath, EndsHoweverFarItIsAsked) {
    const std::vector<Site> sites = random_sites(100, 4.0, 71);
    const CellData cells(sites, cube());
    for (const GrainMethod method : {GrainMethod::cells, GrainMethod::sphere_tracing, GrainMethod::hyperboloid}) {
        GrainsView grains;
        grains.method = method;
        grains.cells = cells.field();
        Draws draws(72);
        for (int n = 0; n < 2000; ++n) {
            const Vec3 origin = to_vec3(draws.in_cube(half_mm)), direction = draws.direction();
            GrainPath path(grains, origin, direction);
            constexpr float far_mm = 1.0e6f;
            float distance = 0.0f;
            int grain = 0, met = 0;
            while ((grain = path.next_grain(grain, distance, far_mm)) != 0) ASSERT_LT(++met, 1000);
            EXPECT_EQ(distance, far_mm);
        }
    }
}

TEST(CellWalk, EqualsTheOracleOnManySites) {
    expect_exact(errors_of<CellWalk>(random_sites(27000, 0.2, 13), 6, 14));
}

TEST(CellWalk, EqualsTheOracleOnClusters) {
    std::vector<Site> sites;
    Draws draws(15);
    for (int cluster = 0; cluster < 12; ++cluster) {
        const openvdb::Vec3d middle = draws.in_cube(0.9 * half_mm);
        const double size_mm = std::pow(10.0, -2.5 * draws.next());
        for (int n = 0; n < 25; ++n)
            sites.push_back(
                {rounded(middle + draws.in_cube(size_mm)), float(0.2 * size_mm * draws.next()), std::int32_t(sites.size()) + 1});
    }
    expect_exact(errors_of<CellWalk>(sites, 200, 16));
}

/// Sites that all but own nothing: their cells are needles, or hyperboloids about the line through two sites.
TEST(CellWalk, EqualsTheOracleOnNearlyHiddenSites) {
    std::vector<Site> sites;
    Draws draws(17);
    for (int pair = 0; pair < 60; ++pair) {
        const openvdb::Vec3d place = rounded(draws.in_cube(half_mm));
        const openvdb::Vec3d other = rounded(place + draws.in_cube(1.0));
        const double gap_mm = (other - place).length();
        sites.push_back({place, float(gap_mm), std::int32_t(sites.size()) + 1});
        sites.push_back({other, float(gap_mm * std::pow(10.0, -4.0 * draws.next())), std::int32_t(sites.size()) + 1});
    }
    expect_exact(errors_of<CellWalk>(sites, 200, 18), 1.0e-3);
}

/// A ray leaves a large cell for a small one in front and comes back behind it.
TEST(CellWalk, ComesBackIntoAStarShapedCell) {
    const std::vector<Site> sites = {{{0.0, 0.0, 0.0}, 0.5f, 1}, {{2.0, 0.0, 0.0}, -0.5f, 2}};
    const CellData cells(sites, cube());
    const Vec3 origin{3.0f, -5.0f, 0.0f}, direction{0.0f, 1.0f, 0.0f};
    const auto walked = walked_stretches(CellWalk(cells.field(), origin, direction), 10.0f);
    ASSERT_EQ(walked.size(), 3u);
    EXPECT_EQ(walked[0].grain, 1);
    EXPECT_EQ(walked[1].grain, 2);
    EXPECT_EQ(walked[2].grain, 1);
    // Where |x| - |x - (2, 0, 0)| = 1 at x = 3: the hyperbola (x - 1)^2 / 0.25 - y^2 / 0.75 = 1.
    const double y_mm = std::sqrt(0.75 * (4.0 / 0.25 - 1.0));
    EXPECT_NEAR(walked[1].begin_mm, 5.0 - y_mm, 1.0e-5 + 1.0e-6 * y_mm);
    EXPECT_NEAR(walked[2].begin_mm, 5.0 + y_mm, 1.0e-5 + 1.0e-6 * y_mm);
}

TEST(CellWalk, OneAndTwoSites) {
    const CellData one({{{1.0, 2.0, 3.0}, 0.1f, 7}}, cube());
    const auto alone = walked_stretches(CellWalk(one.field(), {0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}), 10.0f);
    ASSERT_EQ(alone.size(), 1u);
    EXPECT_EQ(alone[0].grain, 7);
    const CellData two({{{-1.0, 0.0, 0.0}, 0.0f, 1}, {{1.0, 0.0, 0.0}, 0.0f, 2}}, cube());
    const auto both = walked_stretches(CellWalk(two.field(), {-3.0f, 0.5f, 0.5f}, {1.0f, 0.0f, 0.0f}), 10.0f);
    ASSERT_EQ(both.size(), 2u);
    EXPECT_NEAR(both[1].begin_mm, 3.0, 2.0e-5);
}

TEST(CellWalk, GrownTogetherIsNoCrossing) {
    std::vector<Site> sites = random_sites(300, 0.5, 21);
    for (Site& site : sites) site.grain = 1 + site.grain % 5;
    expect_exact(errors_of<CellWalk>(sites, 100, 22));
    for (Site& site : sites) site.grain = 3;
    const CellData cells(sites, cube());
    EXPECT_EQ(walked_stretches(CellWalk(cells.field(), {-9.0f, 1.0f, 2.0f}, {1.0f, 0.0f, 0.0f}), 18.0f).size(), 1u);
}

/// Sites in planes, rays in planes between them: everything ties. The walk ends, and never stays where another site is nearer.
TEST(CellWalk, LatticeSitesAndRaysInTheirPlanes) {
    std::vector<Site> sites;
    for (int x = -4; x <= 4; ++x)
        for (int y = -4; y <= 4; ++y)
            for (int z = -4; z <= 4; ++z)
                sites.push_back({openvdb::Vec3d(2.0 * x, 2.0 * y, 2.0 * z), 0.0f, std::int32_t(sites.size()) + 1});
    const CellData cells(sites, cube());
    const Vec3 directions[] = {{1.0f, 0.0f, 0.0f},
                               {0.0f, -1.0f, 0.0f},
                               normalize({1.0f, 1.0f, 0.0f}),
                               normalize({1.0f, 1.0f, 1.0f}),
                               normalize({1.0f, -1.0f, 2.0f})};
    const Vec3 origins[] = {
        {-9.0f, 1.0f, 1.0f}, {-1.0f, -1.0f, -1.0f}, {0.0f, 0.0f, 0.0f}, {1.0f, 0.3f, 1.0f}, {-3.0f, 5.0f, 0.0f}};
    for (const Vec3& origin : origins)
        for (const Vec3& direction : directions) {
            const float end = way_out_mm(origin, direction);
            const auto walked = walked_stretches(CellWalk(cells.field(), origin, direction), end);
            ASSERT_LE(walked.size(), 60u);
            for (std::size_t n = 0; n < walked.size(); ++n) {
                const double last = n + 1 < walked.size() ? walked[n + 1].begin_mm : double(end);
                for (const double part : {0.01, 0.5, 0.99})
                    EXPECT_LE(excess_mm(sites, origin, direction, walked[n].begin_mm + part * (last - walked[n].begin_mm),
                                        walked[n].grain),
                              excess_limit_mm);
            }
        }
}

/// From anywhere and from boundaries, with the right cell, a wrong one or none to begin with.
TEST(CellWalk, AnyStartFindsTheOwner) {
    const std::vector<Site> sites = random_sites(300, 0.6, 31);
    const CellData cells(sites, cube());
    const CellField field = cells.field();
    Draws draws(32);
    for (int n = 0; n < 200; ++n) {
        const Vec3 origin = to_vec3(draws.in_cube(half_mm)), direction = draws.direction();
        const float end = way_out_mm(origin, direction);
        const auto walked = walked_stretches(CellWalk(field, origin, direction), end);
        const auto other = walked_stretches(CellWalk(field, origin, direction, int(draws.next() * field.num_sites)), end);
        ASSERT_EQ(walked.size(), other.size());
        for (std::size_t k = 0; k < walked.size(); ++k) EXPECT_EQ(walked[k].grain, other[k].grain);
        if (walked.size() < 2) continue;
        // From the first crossing, as if rounding had left the light on either side of it.
        const Vec3 boundary = origin + float(walked[1].begin_mm) * direction;
        const float rest = end - float(walked[1].begin_mm);
        for (const float side : {1.0f, -1.0f}) {
            const auto on = walked_stretches(CellWalk(field, boundary, side * direction, n % field.num_sites), 0.9f * rest);
            for (std::size_t k = 0; k < on.size(); ++k)
                EXPECT_LE(excess_mm(sites, boundary, side * direction, on[k].begin_mm + 1.0e-5, on[k].grain), excess_limit_mm);
        }
    }
}

/// Sites on a sphere, whose cells all meet in its middle; sites in a plane, whose cells are columns: to 1e-6 mm. Rays through the
/// vertex, and along the columns.
TEST(CellWalk, NearlyCosphericalAndCoplanarSites) {
    std::vector<Site> sphere, plane;
    Draws draws(35);
    for (int n = 0; n < 60; ++n) {
        const Vec3 v = draws.direction();
        sphere.push_back({rounded((4.0 + 1.0e-6 * draws.signed_next()) * openvdb::Vec3d(v.x, v.y, v.z)), 0.0f, n + 1});
        plane.push_back(
            {rounded({half_mm * draws.signed_next(), half_mm * draws.signed_next(), 1.0e-6 * draws.signed_next()}), 0.0f, n + 1});
    }
    const CellData about_a_point(sphere, cube()), columns(plane, cube());
    for (int n = 0; n < 300; ++n) {
        const bool through_vertex = n % 2 == 0;
        const std::vector<Site>& sites = through_vertex ? sphere : plane;
        const Vec3 direction = through_vertex ? draws.direction() : Vec3{0.0f, 0.0f, n % 4 == 1 ? 1.0f : -1.0f};
        const Vec3 aim = through_vertex ? Vec3{0.0f, 0.0f, 0.0f} : to_vec3(draws.in_cube(0.9 * half_mm));
        const Vec3 origin = aim - (through_vertex ? 8.0f : 0.0f) * direction;
        const CellData& cells = through_vertex ? about_a_point : columns;
        const float end = through_vertex ? 16.0f : way_out_mm(origin, direction);
        const auto walked = walked_stretches(CellWalk(cells.field(), origin, direction), end);
        ASSERT_LE(walked.size(), 60u);
        for (std::size_t k = 0; k < walked.size(); ++k) {
            const double last = k + 1 < walked.size() ? walked[k + 1].begin_mm : double(end);
            for (const double part : {0.01, 0.5, 0.99})
                EXPECT_LE(
                    excess_mm(sites, origin, direction, walked[k].begin_mm + part * (last - walked[k].begin_mm), walked[k].grain),
                    excess_limit_mm);
        }
    }
}

TEST(CellWalk, EndsWhateverItIsGiven) {
    const CellData cells(random_sites(100, 0.5, 41), cube());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Vec3 origins[] = {{0.0f, 0.0f, 0.0f}, {1.0e4f, 0.0f, 0.0f}, {nan, 0.0f, 0.0f}, {1.0e30f, 1.0e30f, 1.0e30f}};
    const Vec3 directions[] = {{1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, {nan, nan, nan}};
    for (const Vec3& origin : origins)
        for (const Vec3& direction : directions)
            EXPECT_LE(walked_stretches(CellWalk(cells.field(), origin, direction), 100.0f).size(), 200u);
}

TEST(CellWalk, HiddenSitesDoNotMatter) {
    std::vector<Site> sites = random_sites(200, 0.5, 51);
    const CellData without(sites, cube());
    Draws draws(52);
    for (int n = 0; n < 200; ++n) {
        // Marked as hidden; and not marked, but behind a heavier one.
        sites.push_back({draws.in_cube(half_mm), 30.0f, 0});
        const Site& strong = sites[std::size_t(n)];
        if (strong.grain != 0)
            sites.push_back({strong.position_mm + openvdb::Vec3d(0.1, 0.0, 0.0), strong.weight_mm - 0.2f, 900});
    }
    const CellData with(sites, cube());
    EXPECT_EQ(with.field().num_sites, without.field().num_sites);
    for (int n = 0; n < 100; ++n) {
        const Vec3 origin = to_vec3(draws.in_cube(half_mm)), direction = draws.direction();
        const auto a = walked_stretches(CellWalk(with.field(), origin, direction), 5.0f);
        const auto b = walked_stretches(CellWalk(without.field(), origin, direction), 5.0f);
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].grain, b[k].grain);
    }
}

/// Every two cells that share a boundary are in each other's lists, and the lists are hardly longer than that.
TEST(CellData, ListsHoldAllNeighbours) {
    for (const double spread_mm : {0.0, 0.8, 3.0}) {
        const std::vector<Site> sites = random_sites(250, spread_mm, 61);
        const CellData cells(sites, cube());
        const CellField field = cells.field();
        std::vector<std::set<int>> lists(251);
        std::size_t entries = 0;
        for (int cell = 0; cell < field.num_sites; ++cell)
            for (std::uint32_t k = field.first[cell]; k < field.first[cell + 1]; ++k, ++entries)
                lists[std::size_t(field.grain[cell])].insert(field.grain[field.neighbors[k]]);
        std::set<std::pair<int, int>> met;
        Draws draws(62);
        for (int n = 0; n < 6000; ++n) {
            const Vec3 origin = to_vec3(draws.in_cube(half_mm)), direction = draws.direction();
            const auto exact = exact_stretches(sites, origin, direction, double(way_out_mm(origin, direction)));
            for (std::size_t k = 1; k < exact.size(); ++k) {
                EXPECT_TRUE(lists[std::size_t(exact[k].grain)].count(exact[k - 1].grain));
                EXPECT_TRUE(lists[std::size_t(exact[k - 1].grain)].count(exact[k].grain));
                met.insert({exact[k].grain, exact[k - 1].grain});
                met.insert({exact[k - 1].grain, exact[k].grain});
            }
        }
        // Small faces are seldom met.
        EXPECT_LE(double(entries), 1.25 * double(met.size()));
    }
}

TEST(CellData, SameFromAnyNumberOfThreads) {
    const std::vector<Site> sites = random_sites(2000, 0.3, 71);
    const auto make = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return CellData(sites, cube());
    };
    const CellData one = make(1), many = make(5);
    ASSERT_EQ(one.size_bytes(), many.size_bytes());
    const CellField a = one.field(), b = many.field();
    EXPECT_TRUE(std::equal(a.first, a.first + a.num_sites + 1, b.first));
    EXPECT_TRUE(std::equal(a.neighbors, a.neighbors + a.first[a.num_sites], b.neighbors));
    EXPECT_TRUE(std::equal(a.start_site, a.start_site + a.boxes[0] * a.boxes[1] * a.boxes[2], b.start_site));
}

/// The published ways err where their pages say, and the comparison sees it.
TEST(PublishedWalks, ErrWhereExpected) {
    const WalkErrors traced = errors_of<SphereTracingWalk>(random_sites(300, 0.5, 81), 40, 82);
    EXPECT_LE(traced.largest_error_mm, 0.01);
    EXPECT_GT(traced.error_sum_mm, 1.0e-6 * double(traced.crossings));
    EXPECT_LE(traced.missed, traced.crossings / 50);
    const WalkErrors equal = errors_of<HyperboloidWalk>(random_sites(300, 0.0, 83), 40, 84);
    EXPECT_GT(equal.missed, equal.crossings / 20);  // a double root, lost to rounding
    const WalkErrors curved = errors_of<HyperboloidWalk>(random_sites(300, 0.9, 85), 40, 86);
    EXPECT_GT(curved.wrong_mm, 1.0e-4 * curved.length_mm);
    EXPECT_LE(curved.missed, curved.crossings / 10);
}

}  // namespace
}  // namespace opal
