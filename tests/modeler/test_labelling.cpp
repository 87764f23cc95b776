// SPDX-License-Identifier: Apache-2.0
#include "modeler/labelling.h"

#include <cmath>

#include "labelling_test_tools.h"

namespace opal {
namespace {

using testing_tools::expect_searched_labels;
using testing_tools::one_label_each;
using testing_tools::random_sites;
using testing_tools::shape_of;

struct LabellingCase {
    const char* name;
    ShapeKind kind;
    std::array<double, 3> size_mm;
    double voxel_size_mm;
    std::size_t sites;
    double weight_spread_mm;
    Tessellation tessellation = {};
};

void PrintTo(const LabellingCase& which, std::ostream* stream) {
    *stream << which.name;
}

class Labelling : public ::testing::TestWithParam<LabellingCase> {};

TEST_P(Labelling, EqualsASearchThroughAllSites) {
    const LabellingCase& which = GetParam();
    const auto shape = shape_of(which.kind, which.size_mm);
    std::vector<Site> sites = random_sites(shape->bounds_mm(), which.sites, which.weight_spread_mm, 11);
    if (which.tessellation.kind == TessellationKind::multiplicative)
        for (Site& site : sites) site.weight_mm = std::exp(site.weight_mm);
    const auto level_set = shape->level_set(which.voxel_size_mm);
    const std::vector<std::int32_t> labels = one_label_each(sites);
    const auto grid = testing_tools::with_threads(1, [&] { return label_voxels(sites, labels, *level_set, which.tessellation); });
    expect_searched_labels(*grid, *level_set, sites, labels, which.tessellation);
    for (const int threads : {2, 7})
        EXPECT_TRUE(testing_tools::same_grids(*grid, *testing_tools::with_threads(threads, [&] {
            return label_voxels(sites, labels, *level_set, which.tessellation);
        })));
}

constexpr auto additive = TessellationKind::additive;
constexpr auto multiplicative = TessellationKind::multiplicative;
constexpr auto manhattan = TessellationKind::manhattan;
constexpr BoundaryNoiseRecipe rough = {0.08, 0.7, 2};

INSTANTIATE_TEST_SUITE_P(
    Cases, Labelling,
    ::testing::Values(
        LabellingCase{"dense, no tiles", ShapeKind::ellipsoid, {4.0, 3.0, 2.0}, 0.08, 3000, 0.05},
        LabellingCase{"voronoi", ShapeKind::cabochon, {6.0, 5.0, 3.0}, 0.06, 60, 0.0},
        LabellingCase{"weighted, with tiles", ShapeKind::ellipsoid, {6.0, 6.0, 4.0}, 0.05, 12, 0.4},
        LabellingCase{"nearly equal weights", ShapeKind::ellipsoid, {5.0, 4.0, 3.0}, 0.06, 100, 1.0e-7},
        LabellingCase{"most sites hidden", ShapeKind::ellipsoid, {5.0, 4.0, 3.0}, 0.06, 200, 3.0},
        LabellingCase{"one site", ShapeKind::sphere, {5.0, 5.0, 5.0}, 0.1, 1, 0.0},
        LabellingCase{"one voxel thin", ShapeKind::box, {8.0, 8.0, 0.06}, 0.05, 20, 0.2},
        LabellingCase{"factors", ShapeKind::ellipsoid, {5.0, 4.0, 3.0}, 0.06, 150, 0.5, {multiplicative, {}, 0}},
        LabellingCase{"factors from e^-8 to e^8", ShapeKind::ellipsoid, {5.0, 4.0, 3.0}, 0.06, 150, 8.0, {multiplicative, {}, 0}},
        LabellingCase{"equal factors", ShapeKind::box, {5.0, 4.0, 3.0}, 0.08, 80, 0.0, {multiplicative, {}, 0}},
        LabellingCase{"Manhattan", ShapeKind::ellipsoid, {5.0, 4.0, 3.0}, 0.06, 150, 0.3, {manhattan, {}, 0}},
        LabellingCase{"Manhattan, most sites hidden", ShapeKind::cabochon, {5.0, 4.0, 3.0}, 0.08, 150, 4.0, {manhattan, {}, 0}},
        LabellingCase{"boundary noise", ShapeKind::ellipsoid, {5.0, 4.0, 3.0}, 0.05, 60, 0.2, {additive, rough, 3}},
        LabellingCase{"boundary noise finer than a voxel",
                      ShapeKind::ellipsoid,
                      {5.0, 4.0, 3.0},
                      0.08,
                      60,
                      0.2,
                      {additive, {0.3, 0.01, 3}, 3}},
        LabellingCase{
            "boundary noise wider than cells", ShapeKind::box, {5.0, 4.0, 3.0}, 0.08, 300, 0.1, {additive, {2.0, 0.5, 2}, 3}},
        LabellingCase{
            "boundary noise of factors", ShapeKind::ellipsoid, {5.0, 4.0, 3.0}, 0.08, 60, 0.6, {multiplicative, rough, 3}},
        LabellingCase{"boundary noise, Manhattan", ShapeKind::ellipsoid, {5.0, 4.0, 3.0}, 0.08, 60, 0.2, {manhattan, rough, 3}},
        LabellingCase{"far smaller than its voxels' blocks", ShapeKind::sphere, {0.01, 0.01, 0.01}, 0.002, 5, 0.001}));

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

TEST(Labelling, CountsMoreVoxelsThan32BitsHold) {
    // 2048 x 2048 x 1024 voxels inside, given as tiles; leaves at two corners say where the band ends.
    openvdb::FloatGrid shape(0.3f);
    shape.setTransform(openvdb::math::Transform::createLinearTransform(0.01));
    shape.tree().fill(openvdb::CoordBBox({0, 0, 0}, {2047, 2047, 1023}), -0.3f, false);
    for (const openvdb::Coord& corner : {openvdb::Coord(-8, -8, -8), openvdb::Coord(2048, 2048, 1024)})
        shape.tree().setValueOn(corner, 0.3f);
    std::vector<Site> sites = random_sites({openvdb::Vec3d(0.0), openvdb::Vec3d(20.0)}, 20, 0.5, 3);
    const auto one_grain = label_voxels(sites, std::vector<std::int32_t>(sites.size(), 7), shape);
    EXPECT_EQ(one_grain->activeVoxelCount(), std::uint64_t(1) << 32);
    EXPECT_EQ(one_grain->tree().leafCount(), 1u);

    // Two grains meet in the middle: x = 10.235 mm lies between voxels 1023 and 1024.
    sites.resize(2);
    for (Site& site : sites) site.weight_mm = 0.0f;
    sites[0].position_mm = {5.235, 10.0, 5.0};
    sites[1].position_mm = {15.235, 10.0, 5.0};
    const auto two_grains = label_voxels(sites, {1, 2}, shape);
    EXPECT_EQ(two_grains->activeVoxelCount(), std::uint64_t(1) << 32);
    EXPECT_EQ(two_grains->tree().getValue({1023, 5, 900}), 1);
    EXPECT_EQ(two_grains->tree().getValue({1024, 5, 900}), 2);
}

}  // namespace
}  // namespace opal
