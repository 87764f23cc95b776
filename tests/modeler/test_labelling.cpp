// SPDX-License-Identifier: Apache-2.0
#include "modeler/labelling.h"

#include <limits>
#include <numeric>

#include "modeler/shape.h"
#include "modeler/site_culling.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

using testing_tools::random_sites;

std::unique_ptr<Shape> shape_of(ShapeKind kind, std::array<double, 3> size_mm) {
    ShapeRecipe recipe;
    recipe.kind = kind;
    recipe.size_mm = size_mm;
    recipe.girdle_mm = 0.2 * size_mm[2];
    return make_shape(recipe);
}

std::vector<std::int32_t> one_label_each(const std::vector<Site>& sites) {
    std::vector<std::int32_t> labels(sites.size());
    std::iota(labels.begin(), labels.end(), 1);
    return labels;
}

/// The site that a search through all of them finds, lowest index first.
std::int32_t searched_owner(const openvdb::Vec3d& x, const std::vector<Site>& sites, const std::vector<std::int32_t>& labels) {
    double smallest = std::numeric_limits<double>::infinity();
    std::int32_t owner = 0;
    for (std::size_t n = 0; n < sites.size(); ++n) {
        const double delta = weighted_distance_mm(x, sites[n]);
        if (labels[n] != 0 && delta < smallest) smallest = delta, owner = labels[n];
    }
    return owner;
}

void expect_searched_labels(const openvdb::Int32Grid& grid, const openvdb::FloatGrid& shape, const std::vector<Site>& sites,
                            const std::vector<std::int32_t>& labels) {
    openvdb::CoordBBox box;
    ASSERT_TRUE(shape.tree().evalLeafBoundingBox(box));
    const double h = shape.voxelSize().x();
    auto distances = shape.getConstAccessor();
    auto values = grid.getConstAccessor();
    std::uint64_t inside = 0;
    for (const openvdb::Coord& voxel : box) {
        const bool is_inside = distances.getValue(voxel) < 0.0f;
        inside += is_inside ? 1 : 0;
        ASSERT_EQ(values.isValueOn(voxel), is_inside) << voxel;
        ASSERT_EQ(values.getValue(voxel), is_inside ? searched_owner(voxel.asVec3d() * h, sites, labels) : 0) << voxel;
    }
    EXPECT_EQ(grid.activeVoxelCount(), inside);
    EXPECT_EQ(grid.background(), 0);
    EXPECT_GE(grid.tree().leafCount(), 1u);
}

struct LabellingCase {
    const char* name;
    ShapeKind kind;
    std::array<double, 3> size_mm;
    double voxel_size_mm;
    std::size_t sites;
    double weight_spread_mm;
};

void PrintTo(const LabellingCase& which, std::ostream* stream) {
    *stream << which.name;
}

class Labelling : public ::testing::TestWithParam<LabellingCase> {};

TEST_P(Labelling, EqualsASearchThroughAllSites) {
    const LabellingCase& which = GetParam();
    const auto shape = shape_of(which.kind, which.size_mm);
    const std::vector<Site> sites = random_sites(shape->bounds_mm(), which.sites, which.weight_spread_mm, 11);
    const auto level_set = shape->level_set(which.voxel_size_mm);
    const std::vector<std::int32_t> labels = one_label_each(sites);
    expect_searched_labels(*label_voxels(sites, labels, *level_set), *level_set, sites, labels);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, Labelling,
    ::testing::Values(LabellingCase{"dense, no tiles", ShapeKind::ellipsoid, {4.0, 3.0, 2.0}, 0.08, 3000, 0.05},
                      LabellingCase{"voronoi", ShapeKind::cabochon, {6.0, 5.0, 3.0}, 0.06, 60, 0.0},
                      LabellingCase{"weighted, with tiles", ShapeKind::ellipsoid, {6.0, 6.0, 4.0}, 0.05, 12, 0.4},
                      LabellingCase{"nearly equal weights", ShapeKind::ellipsoid, {5.0, 4.0, 3.0}, 0.06, 100, 1.0e-7},
                      LabellingCase{"most sites hidden", ShapeKind::ellipsoid, {5.0, 4.0, 3.0}, 0.06, 200, 3.0},
                      LabellingCase{"one site", ShapeKind::sphere, {5.0, 5.0, 5.0}, 0.1, 1, 0.0},
                      LabellingCase{"one voxel thin", ShapeKind::box, {8.0, 8.0, 0.06}, 0.05, 20, 0.2},
                      LabellingCase{
                          "far smaller than its voxels' blocks", ShapeKind::sphere, {0.01, 0.01, 0.01}, 0.002, 5, 0.001}));

TEST(Labelling, WholeNodesAndLeavesBecomeTilesButOneLeafStays) {
    const auto shape = shape_of(ShapeKind::box, {28.0, 28.0, 28.0});
    const auto level_set = shape->level_set(0.1);
    std::vector<Site> sites(1);
    sites[0].position_mm = {1.0, 2.0, 3.0};
    const auto grid = label_voxels(sites, {5}, *level_set);
    bool has_node_tile = false;
    for (auto value = grid->cbeginValueOn(); value; ++value) {
        openvdb::CoordBBox box;
        value.getBoundingBox(box);
        has_node_tile = has_node_tile || box.dim() == openvdb::Coord(128);
        ASSERT_EQ(*value, 5);
    }
    EXPECT_TRUE(has_node_tile);
    // A box aligned to the blocks holds nothing but tiles; Blender needs a leaf all the same.
    openvdb::FloatGrid aligned(0.3f);
    aligned.setTransform(openvdb::math::Transform::createLinearTransform(0.1));
    aligned.tree().fill(openvdb::CoordBBox({0, 0, 0}, {7, 7, 7}), -0.05f);
    aligned.tree().voxelizeActiveTiles();
    EXPECT_EQ(label_voxels(sites, {5}, aligned)->tree().leafCount(), 1u);
}

TEST(Labelling, EqualSitesGoToTheLowestIndex) {
    const auto shape = shape_of(ShapeKind::sphere, {3.0, 3.0, 3.0});
    const auto level_set = shape->level_set(0.1);
    std::vector<Site> sites(4);
    sites[0].position_mm = sites[1].position_mm = {0.5, 0.0, 1.5};
    sites[2].position_mm = sites[3].position_mm = {-0.5, 0.0, 1.5};  // x = 0 is equally near to both
    const std::vector<std::int32_t> labels = one_label_each(sites);
    const auto grid = label_voxels(sites, labels, *level_set);
    expect_searched_labels(*grid, *level_set, sites, labels);
    EXPECT_EQ(grid->tree().getValue(openvdb::Coord(0, 3, 15)), 1);
}

TEST(Labelling, GrainLabelsEqualMappedSiteLabelsInFewerLeaves) {
    const auto shape = shape_of(ShapeKind::ellipsoid, {6.0, 5.0, 4.0});
    const auto level_set = shape->level_set(0.04);
    const std::vector<Site> sites = random_sites(shape->bounds_mm(), 150, 0.1, 3);
    std::vector<std::int32_t> grain_of_site(sites.size());
    for (std::size_t n = 0; n < sites.size(); ++n) grain_of_site[n] = sites[n].position_mm.x() < 0.5 ? 1 : 2;
    const auto by_site = label_voxels(sites, one_label_each(sites), *level_set);
    const auto by_grain = label_voxels(sites, grain_of_site, *level_set);
    auto grains = by_grain->getConstAccessor();
    for (auto value = by_site->cbeginValueOn(); value; ++value)
        ASSERT_EQ(grains.getValue(value.getCoord()), grain_of_site[std::size_t(*value) - 1]);
    EXPECT_EQ(by_grain->activeVoxelCount(), by_site->activeVoxelCount());
    EXPECT_LT(by_grain->tree().leafCount(), by_site->tree().leafCount());
}

TEST(Labelling, SitesWithoutALabelTakeNoPart) {
    const auto shape = shape_of(ShapeKind::sphere, {3.0, 3.0, 3.0});
    const auto level_set = shape->level_set(0.1);
    const std::vector<Site> sites = random_sites(shape->bounds_mm(), 30, 0.1, 3);
    std::vector<std::int32_t> labels = one_label_each(sites);
    for (std::size_t n = 0; n < labels.size(); n += 3) labels[n] = 0;
    expect_searched_labels(*label_voxels(sites, labels, *level_set), *level_set, sites, labels);
}

TEST(Labelling, DoesNotDependOnThreads) {
    const auto shape = shape_of(ShapeKind::ellipsoid, {6.0, 5.0, 4.0});
    const auto level_set = shape->level_set(0.03);
    const std::vector<Site> sites = random_sites(shape->bounds_mm(), 500, 0.2, 3);
    const auto one = testing_tools::with_threads(1, [&] { return label_voxels(sites, one_label_each(sites), *level_set); });
    const auto two = testing_tools::with_threads(2, [&] { return label_voxels(sites, one_label_each(sites), *level_set); });
    EXPECT_TRUE(testing_tools::same_grids(*one, *two));
}

}  // namespace
}  // namespace opal
