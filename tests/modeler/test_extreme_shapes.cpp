// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <sstream>

#include "modeler/build.h"
#include "modeler/mesh_shape.h"
#include "modeler/sites.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

using openvdb::Vec3d;
using testing_tools::input_error_of;
using testing_tools::write_test_file;

BuiltOpal build(const std::string& shape, const std::string& grains) {
    return build_opal(parse_recipe("[shape]\n" + shape + "\n[grains]\n" + grains, "extreme.toml", {}), [](const std::string&) {});
}

TEST(ExtremeShapes, NeedlesAndPlatesHoldTheVoxelsTheyShould) {
    struct Case {
        std::string shape;
        double voxel_size_mm;
    };
    for (const Case& c : {Case{"kind = \"ellipsoid\"\nsize_mm = [1000.0, 1.0, 1.0]", 0.31},
                          Case{"kind = \"cabochon\"\nsize_mm = [1.0, 0.8, 1000.0]", 0.31},
                          Case{"kind = \"bezier\"\nsize_mm = [1000.0, 1.0, 1.0]", 0.31},
                          Case{"kind = \"box\"\nsize_mm = [0.5, 0.5, 1000.0]", 0.31},
                          Case{"kind = \"box\"\nsize_mm = [100.0, 100.0, 0.1]", 0.08}}) {
        const BuiltOpal built = build(c.shape, "num_sites = 300\nvoxel_size_mm = " + std::to_string(c.voxel_size_mm));
        EXPECT_EQ(built.asset.sites.size(), 300u);
        const Recipe recipe = parse_recipe("[shape]\n" + c.shape + "\n[grains]\n", "shape.toml", {});
        const auto shape = make_shape(recipe.shape);
        const openvdb::BBoxd bounds = shape->bounds_mm();
        std::uint64_t inside = 0;
        for (const openvdb::Coord& voxel : openvdb::CoordBBox(openvdb::Coord::floor(bounds.min() / c.voxel_size_mm),
                                                              openvdb::Coord::ceil(bounds.max() / c.voxel_size_mm)))
            inside += shape->contains(voxel.asVec3d() * c.voxel_size_mm) ? 1 : 0;
        EXPECT_EQ(built.report.voxels, inside) << c.shape;
        EXPECT_GT(inside, 0u) << c.shape;
    }
}

/// A cuboid along a slanted direction, far thinner than its bounds.
std::string slanted_cuboid(double length, double width, double thickness, const Vec3d& corner = Vec3d(0.0)) {
    const Vec3d along = Vec3d(1.0, 1.0, 1.0).unit(), across = Vec3d(1.0, -1.0, 0.0).unit(), up = along.cross(across);
    std::ostringstream text;
    text.precision(9);
    for (const double z : {0.0, 1.0})
        for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) {
            const Vec3d v = corner + x * length * along + y * width * across + z * thickness * up;
            text << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
        }
    text << "f 1 4 3\nf 1 3 2\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 3 4 8\nf 3 8 7\nf 1 5 8\nf 1 8 4\nf 2 3 7\nf 2 7 6\n";
    return text.str();
}

TEST(ExtremeShapes, SlantedNeedlesAndPlatesAreSampled) {
    struct Case {
        double length, width, thickness;
    };
    for (const Case& c : {Case{1000.0, 1.0, 1.0}, {1.0e5, 1.0, 1.0}, {1000.0, 1000.0, 1.0}}) {
        const auto shape = make_mesh_shape(write_test_file("slanted.obj", slanted_cuboid(c.length, c.width, c.thickness)), 1.0);
        const double volume_mm3 = c.length * c.width * c.thickness;
        const SiteSet sites = sample_sites(*shape, 1000, 1);
        ASSERT_EQ(sites.positions_mm.size(), 1000u);
        // 10,000 hits at a rate above 1/16: standard error below 1 %; vertices are floats.
        EXPECT_NEAR(sites.shape_volume_mm3 / volume_mm3, 1.0, 0.04);
        // Uniform along the length: mean 1/2 to 4 x 0.29 / sqrt(1000), sites of a Poisson disk being more even than that.
        double mean = 0.0;
        for (const Vec3d& p : sites.positions_mm) {
            ASSERT_TRUE(shape->contains(p));
            mean += p.dot(Vec3d(1.0, 1.0, 1.0).unit()) / c.length / 1000.0;
        }
        EXPECT_NEAR(mean, 0.5, 0.037);
        GrainsRecipe lattice;
        lattice.num_sites = 1000;
        lattice.sites.kind = SiteKind::jittered_lattice;
        EXPECT_EQ(sample_sites(*shape, lattice).positions_mm.size(), 1000u);
    }
}

TEST(ExtremeShapes, ScaleDoesNotMatter) {
    // A thousandth of a millimetre and a kilometre: the same opal as at 1 mm, but for the scale.
    // Away from the origin, or a face would hold many voxels' centres, which rounding decides.
    const Vec3d corner(0.0123, 0.0071, 0.0037);
    const std::string mesh =
        "kind = \"mesh\"\nfile = \"" + write_test_file("unit.obj", slanted_cuboid(1.0, 0.7, 0.5, corner)) + "\"\n";
    for (const std::string& kind :
         {std::string("ellipsoid"), std::string("box"), std::string("cabochon"), std::string("bezier"), std::string("mesh")}) {
        std::vector<BuiltOpal> built;
        for (const double scale : {1.0, 1.0e-3, 1.0e6}) {
            std::ostringstream shape, grains;
            shape.precision(17);
            grains.precision(17);
            if (kind == "mesh")
                shape << mesh << "scale = " << scale;
            else
                shape << "kind = \"" << kind << "\"\nsize_mm = [" << scale << ", " << 0.75 * scale << ", " << 0.5 * scale << "]";
            grains << "num_sites = 200\nresolution = 60\nweight = { kind = \"none\" }";
            built.push_back(build(shape.str(), grains.str()));
        }
        const BuiltOpal& reference = built[0];
        for (const std::size_t n : {1u, 2u}) {
            const double scale = n == 1 ? 1.0e-3 : 1.0e6;
            EXPECT_EQ(built[n].asset.sites.size(), 200u);
            // Rounding may move single voxels across a border.
            EXPECT_NEAR(double(built[n].report.voxels), double(reference.report.voxels), 0.001 * double(reference.report.voxels))
                << kind;
            EXPECT_NEAR(built[n].report.relative_radius, reference.report.relative_radius, 1e-6) << kind;
            for (std::size_t k = 0; k < 200; ++k)
                ASSERT_TRUE((built[n].asset.sites[k].position_mm / scale).eq(reference.asset.sites[k].position_mm, 1e-6)) << kind;
        }
    }
}

TEST(ExtremeShapes, AShapeBetweenTheVoxelsIsRefused) {
    // Resting on z = 0, where voxels have their centres; half a voxel up there is nothing.
    const std::string speck = "kind = \"sphere\"\nsize_mm = [0.01, 0.01, 0.01]";
    const auto message = input_error_of([&] { build(speck, "num_sites = 3\nvoxel_size_mm = 1.0"); });
    EXPECT_NE(message.find("no voxel's centre lies inside the shape of 0.01 x 0.01 x 0.01 mm; choose smaller voxels"),
              std::string::npos)
        << message;
}

TEST(ExtremeShapes, AShapeAroundASingleVoxelHasOneVoxel) {
    const auto file = write_test_file("around_origin.obj", slanted_cuboid(0.02, 0.02, 0.02));
    const auto bounds = make_mesh_shape(file, 1.0)->bounds_mm();
    // Moved so that the origin, a voxel's centre, is inside.
    std::ostringstream moved;
    std::istringstream lines(slanted_cuboid(0.02, 0.02, 0.02));
    const Vec3d centre = bounds.getCenter();
    for (std::string line; std::getline(lines, line);) {
        Vec3d v;
        if (std::sscanf(line.c_str(), "v %lf %lf %lf", &v[0], &v[1], &v[2]) == 3)
            moved << "v " << v.x() - centre.x() << ' ' << v.y() - centre.y() << ' ' << v.z() - centre.z() << '\n';
        else
            moved << line << '\n';
    }
    const std::string mesh = "kind = \"mesh\"\nfile = \"" + write_test_file("one_voxel.obj", moved.str()) + '"';
    const BuiltOpal built = build(mesh, "num_sites = 3\nvoxel_size_mm = 1.0");
    EXPECT_EQ(built.report.voxels, 1u);
}

TEST(ExtremeShapes, OneTwoAndThreeSites) {
    for (const std::string& kind : {std::string("poisson-disk"), std::string("jittered-lattice")})
        for (const std::string& region : {std::string("shape"), std::string("bounds")})
            for (const int count : {1, 2, 3}) {
                const BuiltOpal built = build("kind = \"ellipsoid\"", "num_sites = " + std::to_string(count) +
                                                                          "\nvoxel_size_mm = 0.2\nsites = { kind = \"" + kind +
                                                                          "\", region = \"" + region + "\" }");
                EXPECT_EQ(built.asset.sites.size(), std::size_t(count));
                EXPECT_GT(built.report.voxels, 0u);
                EXPECT_EQ(built.report.shortest_site_distance_mm > 0.0, count > 1);
            }
}

}  // namespace
}  // namespace opal
