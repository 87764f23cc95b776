// SPDX-License-Identifier: Apache-2.0
#include <openvdb/points/PointConversion.h>

#include <filesystem>

#include "modeler/build.h"
#include "modeler/site_file.h"
#include "modeler/sites.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

using openvdb::Vec3d;
using testing_tools::input_error_of;
using testing_tools::write_test_file;

std::unique_ptr<Shape> ball() {
    ShapeRecipe recipe;
    recipe.kind = ShapeKind::sphere;
    recipe.size_mm = {10.0, 10.0, 10.0};
    return make_shape(recipe);
}

GrainsRecipe from_file(const std::string& file, double scale = 1.0) {
    GrainsRecipe grains;
    grains.sites.kind = SiteKind::file;
    grains.sites.file = file;
    grains.sites.file_scale = scale;
    return grains;
}

TEST(SiteFiles, CsvIsReadWithAndWithoutAHeader) {
    const std::string points = "0.1,0.2,5\n\n# far\n -1.5e0 , +2.25,6.125,a name\r\n0.30000000000000004,0,4\n";
    const std::vector<Vec3d> expected = {{0.1, 0.2, 5.0}, {-1.5, 2.25, 6.125}, {0.1 + 0.2, 0.0, 4.0}};
    EXPECT_EQ(read_site_file(write_test_file("plain.csv", points), 1.0), expected);
    EXPECT_EQ(read_site_file(write_test_file("header.csv", "x,y,z,label\n" + points), 1.0), expected);
    EXPECT_EQ(read_site_file(write_test_file("metres.csv", "0.001,0.002,0.005\n"), 1000.0),
              (std::vector<Vec3d>{{1.0, 2.0, 5.0}}));
}

TEST(SiteFiles, BrokenCsvIsRefusedWithItsLine) {
    const auto error_for = [](const std::string& text) {
        return input_error_of([&] { read_site_file(write_test_file("bad.csv", text), 1.0); });
    };
    EXPECT_NE(error_for("x,y,z\n1,2,3\n1,2\n").find("bad.csv:3: '1,2' is not x,y,z"), std::string::npos);
    EXPECT_NE(error_for("1,2,nan\n").find("bad.csv:1:"), std::string::npos);
    EXPECT_NE(error_for("1,2,3\nx,y,z\n").find("bad.csv:2:"), std::string::npos);
    EXPECT_NE(error_for("1;2;3\n").find("bad.csv:1:"), std::string::npos);
    EXPECT_NE(error_for("# nothing\n").find("holds no points"), std::string::npos);
    EXPECT_NE(input_error_of([] { read_site_file("/nowhere/sites.csv", 1.0); }).find("no such file"), std::string::npos);
    EXPECT_NE(input_error_of([] { read_site_file(write_test_file("sites.txt", "1,2,3"), 1.0); }).find(".csv, .ply, .vdb"),
              std::string::npos);
}

TEST(SiteFiles, PlyIsReadWithAndWithoutFaces) {
    const std::string start = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string vertices = "0 0 1\n1 0 1\n0 1 1\n0.5 0.5 2\n";
    const std::vector<Vec3d> expected = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0.5, 0.5, 2}};
    EXPECT_EQ(read_site_file(write_test_file("cloud.ply", start + "end_header\n" + vertices), 1.0), expected);
    // The last vertex belongs to no face.
    const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    EXPECT_EQ(read_site_file(write_test_file("faces.ply", start + faces + vertices + "3 0 1 2\n"), 1.0), expected);
    EXPECT_NE(input_error_of([&] { read_site_file(write_test_file("broken.ply", "plain"), 1.0); }).find("broken.ply"),
              std::string::npos);
}

TEST(SiteFiles, OurOwnOpalKeepsTheOrderOfItsSites) {
    const std::string recipe = "[shape]\nkind = \"sphere\"\n[grains]\nnum_sites = 500\nvoxel_size_mm = 0.25\n";
    const BuiltOpal built = build_opal(parse_recipe(recipe, "ball.toml", {}), [](const std::string&) {});
    const std::string file = testing_tools::temporary_file("own_sites.vdb");
    write_opal_asset(built.asset, file);
    const std::vector<Vec3d> read = read_site_file(file, 1.0);
    ASSERT_EQ(read.size(), built.asset.sites.size());
    // Positions are floats in voxels of the points' grid, about a spacing (1 mm) wide.
    for (std::size_t n = 0; n < read.size(); ++n) ASSERT_TRUE(read[n].eq(built.asset.sites[n].position_mm, 1e-6)) << n;

    const SiteSet again = sample_sites(*ball(), from_file(file));
    EXPECT_EQ(again.duplicates, 0u);
    EXPECT_TRUE(again.warnings.empty());
    EXPECT_NEAR(again.relative_radius, built.report.relative_radius, 0.02);
}

TEST(SiteFiles, ForeignPointsAreReadByTheirTransform) {
    namespace points = openvdb::points;
    initialize_openvdb();
    const std::vector<openvdb::Vec3f> positions = {{1.0f, 2.0f, 3.0f}, {-4.0f, 0.5f, 0.0f}};
    const auto transform = openvdb::math::Transform::createLinearTransform(0.7);
    transform->postTranslate({0.1, 0.2, 0.3});
    const auto grid = points::createPointDataGrid<points::NullCodec, points::PointDataGrid>(positions, *transform);
    grid->setName("cloud");
    const std::string file = testing_tools::temporary_file("foreign_points.vdb");
    openvdb::io::File(file).write({grid});
    std::vector<Vec3d> read = read_site_file(file, 2.0);
    ASSERT_EQ(read.size(), 2u);
    std::sort(read.begin(), read.end());
    EXPECT_TRUE(read[0].eq({-8.0, 1.0, 0.0}, 1e-6));
    EXPECT_TRUE(read[1].eq({2.0, 4.0, 6.0}, 1e-6));

    const auto floats = openvdb::FloatGrid::create();
    floats->setName("density");
    const std::string no_points = testing_tools::temporary_file("no_points.vdb");
    openvdb::io::File(no_points).write({floats});
    EXPECT_NE(input_error_of([&] { read_site_file(no_points, 1.0); }).find("no grid of points (found: density)"),
              std::string::npos);
}

TEST(SiteFiles, DuplicatesAndFarSitesAreCounted) {
    const auto file = write_test_file("odd.csv", "0,0,5\n1,0,5\n0,0,5\n0,0,5\n0,0,900\n");
    const SiteSet sites = sample_sites(*ball(), from_file(file));
    EXPECT_EQ(sites.positions_mm.size(), 5u);
    EXPECT_EQ(sites.duplicates, 2u);
    EXPECT_DOUBLE_EQ(sites.shortest_distance_mm, 1.0);  // of distinct sites
    ASSERT_EQ(sites.warnings.size(), 2u);
    EXPECT_NE(sites.warnings[0].find("1 of 5 sites lie more than"), std::string::npos) << sites.warnings[0];
    EXPECT_NE(sites.warnings[1].find("2 of 5 sites lie at the place"), std::string::npos) << sites.warnings[1];
    const auto message = input_error_of([&] { sample_sites(*ball(), from_file(file, 1000.0)); });
    EXPECT_NE(message.find("none of the 5 sites lies near the shape"), std::string::npos) << message;
}

TEST(SiteFiles, ClusteredSitesAreMeasuredSoon) {
    // 20,000 sites within a thousandth of the ball: a search cell of their mean spacing would hold them all.
    std::string text;
    for (int n = 0; n < 20000; ++n) {
        const Vec3d p = testing_tools::random_point({{0.0, 0.0, 5.0}, {0.01, 0.01, 5.01}}, 8, std::uint64_t(n));
        text +=
            std::to_string(1000.0 * p.x()) + ',' + std::to_string(1000.0 * p.y()) + ',' + std::to_string(1000.0 * p.z()) + '\n';
    }
    const SiteSet sites = sample_sites(*ball(), from_file(write_test_file("cluster.csv", text), 1.0e-3));
    EXPECT_GT(sites.shortest_distance_mm, 0.0);
    EXPECT_LT(sites.shortest_distance_mm, 1.0e-4);
}

TEST(SiteFiles, SitesInAnotherUnitThanTheShapeAreRefused) {
    const std::string file = write_test_file("metres.csv", "0.01,0,0\n0,0.02,0\n0,0,0.01\n-0.01,0,0\n");
    const GrainsRecipe grains = from_file(file);
    EXPECT_NE(input_error_of([&] { sample_sites(*ball(), grains); }).find("of the shape's 10 mm; allowed: from a hundredth"),
              std::string::npos);
    const GrainsRecipe scaled = from_file(file, 100.0);
    EXPECT_EQ(sample_sites(*ball(), scaled).positions_mm.size(), 4u);
}

}  // namespace
}  // namespace opal
