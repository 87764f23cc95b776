// SPDX-License-Identifier: Apache-2.0
#include "modeler/lattice_sites.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "modeler/sites.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

using openvdb::Coord;
using openvdb::Vec3d;

std::unique_ptr<Shape> shape_of(ShapeKind kind, const std::array<double, 3>& size_mm) {
    ShapeRecipe recipe;
    recipe.kind = kind;
    recipe.size_mm = size_mm;
    return make_shape(recipe);
}

GrainsRecipe lattice_recipe(std::int64_t count, SiteRegion region, double jitter = 1.0) {
    GrainsRecipe grains;
    grains.num_sites = count;
    grains.sites.kind = SiteKind::jittered_lattice;
    grains.sites.region = region;
    grains.sites.jitter = jitter;
    return grains;
}

Coord largest_cell(const std::vector<Coord>& cells) {
    Coord largest(0);
    for (const Coord& cell : cells) largest.maxComponent(cell);
    return largest;
}

TEST(LatticeSites, ACubeOfCubesHasOneSitePerCell) {
    const auto cube = shape_of(ShapeKind::box, {7.3, 7.3, 7.3});
    for (const int n : {1, 2, 3, 30, 64})
        for (const SiteRegion region : {SiteRegion::bounds, SiteRegion::shape}) {
            const std::int64_t count = std::int64_t(n) * n * n;
            const SiteSet sites = sample_sites(*cube, lattice_recipe(count, region));
            ASSERT_EQ(sites.positions_mm.size(), std::size_t(count));
            ASSERT_EQ(sites.lattice_cells.size(), std::size_t(count));
            EXPECT_EQ(largest_cell(sites.lattice_cells), Coord(n - 1)) << n;
            EXPECT_TRUE(std::is_sorted(sites.lattice_cells.begin(), sites.lattice_cells.end()));
            EXPECT_EQ(std::adjacent_find(sites.lattice_cells.begin(), sites.lattice_cells.end()), sites.lattice_cells.end());
            const double cell_mm = 7.3 / n;
            for (std::size_t k = 0; k < sites.positions_mm.size(); ++k) {
                const Vec3d low = sites.lattice_cells[k].asVec3d() * cell_mm - Vec3d(3.65, 3.65, 0.0);
                for (int axis = 0; axis < 3; ++axis) {
                    ASSERT_GE(sites.positions_mm[k][axis], low[axis] - 1e-9);
                    ASSERT_LE(sites.positions_mm[k][axis], low[axis] + cell_mm + 1e-9);
                }
            }
        }
}

TEST(LatticeSites, JitterIsUniformInItsPartOfTheCell) {
    const auto cube = shape_of(ShapeKind::box, {20.0, 20.0, 20.0});
    for (const double jitter : {0.0, 0.4, 1.0}) {
        const SiteSet sites = sample_sites(*cube, lattice_recipe(8000, SiteRegion::bounds, jitter));
        double sum = 0.0, squares = 0.0, farthest = 0.0;
        for (std::size_t k = 0; k < sites.positions_mm.size(); ++k) {
            const Vec3d offset = sites.positions_mm[k] - sites.lattice_cells[k].asVec3d() - Vec3d(-9.5, -9.5, 0.5);
            for (int axis = 0; axis < 3; ++axis) {
                sum += offset[axis];
                squares += offset[axis] * offset[axis];
                farthest = std::max(farthest, std::abs(offset[axis]));
            }
        }
        // 24,000 uniform numbers of width j: mean 0 to 4 x j / sqrt(12 x 24,000), variance j^2 / 12 to 4 x 0.58 %.
        EXPECT_NEAR(sum / 24000.0, 0.0, 0.0075 * jitter + 1e-12);
        EXPECT_NEAR(squares / 24000.0, jitter * jitter / 12.0, 0.023 * jitter * jitter / 12.0 + 1e-12);
        EXPECT_LE(farthest, 0.5 * jitter + 1e-12);
        if (jitter == 0.0) {
            EXPECT_NEAR(sites.shortest_distance_mm, 1.0, 1e-9);
            // Cubic packing over the densest: 1 / 2^(1/6).
            EXPECT_NEAR(sites.relative_radius, std::pow(2.0, -1.0 / 6.0), 1e-9);
        }
    }
}

TEST(LatticeSites, OtherCountsAndShapesAreExactAndCellsStayCubic) {
    const std::vector<std::pair<ShapeKind, std::array<double, 3>>> shapes = {
        {ShapeKind::ellipsoid, {12.0, 9.0, 4.5}}, {ShapeKind::box, {12.0, 9.0, 4.5}}, {ShapeKind::ellipsoid, {40.0, 1.0, 1.0}}};
    for (const auto& [kind, size_mm] : shapes)
        for (const SiteRegion region : {SiteRegion::bounds, SiteRegion::shape})
            for (const std::int64_t count : {1, 2, 3, 900, 5000}) {
                const auto shape = shape_of(kind, size_mm);
                const GrainsRecipe grains = lattice_recipe(count, region);
                const LatticeSites sites = lattice_sites(*shape, grains);
                ASSERT_EQ(sites.positions_mm.size(), std::size_t(count));
                ASSERT_EQ(std::set<Coord>(sites.cells.begin(), sites.cells.end()).size(), std::size_t(count));
                const LatticeSites centres = lattice_sites(*shape, lattice_recipe(count, region, 0.0));
                EXPECT_EQ(centres.cells, sites.cells);
                for (std::size_t n = 0; n < sites.cells.size(); ++n) {
                    // Centres lie a cell apart along every axis.
                    const Vec3d steps = (centres.positions_mm[n] - centres.positions_mm[0]) / centres.cell_mm;
                    ASSERT_TRUE(steps.eq((sites.cells[n] - sites.cells[0]).asVec3d(), 1e-6));
                    ASSERT_TRUE(shape->bounds_mm().isInside(sites.positions_mm[n]));
                    ASSERT_TRUE(region == SiteRegion::bounds || shape->contains(sites.positions_mm[n]));
                }
            }
}

TEST(LatticeSites, SurplusCellsAreTheLeastDeep) {
    const auto shape = shape_of(ShapeKind::ellipsoid, {12.0, 9.0, 4.5});
    const LatticeSites more = lattice_sites(*shape, lattice_recipe(900, SiteRegion::shape, 0.0));
    std::vector<double> depth;
    for (const Vec3d& centre : more.positions_mm) depth.push_back(-shape->signed_distance_mm(centre));
    const double shallowest = *std::min_element(depth.begin(), depth.end());
    // Whatever cell of this lattice has no site lies no deeper.
    const std::set<Coord> taken(more.cells.begin(), more.cells.end());
    const Vec3d origin = more.positions_mm[0] - more.cell_mm * more.cells[0].asVec3d();
    for (const Coord& cell : openvdb::CoordBBox(Coord(0), Coord(40))) {
        if (taken.count(cell) != 0) continue;
        ASSERT_LE(-shape->signed_distance_mm(origin + more.cell_mm * cell.asVec3d()), shallowest + 1e-9) << cell;
    }
}

TEST(LatticeSites, AreAFunctionOfTheSeedAlone) {
    const auto shape = shape_of(ShapeKind::ellipsoid, {12.0, 9.0, 4.5});
    GrainsRecipe grains = lattice_recipe(700, SiteRegion::shape);
    const auto one = testing_tools::with_threads(1, [&] { return sample_sites(*shape, grains); });
    const auto two = testing_tools::with_threads(2, [&] { return sample_sites(*shape, grains); });
    EXPECT_EQ(one.positions_mm, two.positions_mm);
    grains.seed = 2;
    EXPECT_NE(one.positions_mm, sample_sites(*shape, grains).positions_mm);
}

}  // namespace
}  // namespace opal
