// SPDX-License-Identifier: Apache-2.0
#include "modeler/mesh_shape.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "modeler/mesh_file.h"
#include "modeler/sites.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

using testing_tools::input_error_of;
using testing_tools::random_point;
using testing_tools::write_test_file;

/// Two triangles for each face of a cuboid, facing outward; vertex numbers from 1.
constexpr int cuboid_faces[12][3] = {{1, 4, 3}, {1, 3, 2}, {5, 6, 7}, {5, 7, 8}, {1, 2, 6}, {1, 6, 5},
                                     {3, 4, 8}, {3, 8, 7}, {1, 5, 8}, {1, 8, 4}, {2, 3, 7}, {2, 7, 6}};

std::vector<openvdb::Vec3d> cuboid_vertices(const openvdb::Vec3d& low, const openvdb::Vec3d& high) {
    std::vector<openvdb::Vec3d> vertices;
    for (const double z : {low.z(), high.z()})
        for (const auto& [x, y] : {std::pair{low.x(), low.y()}, {high.x(), low.y()}, {high.x(), high.y()}, {low.x(), high.y()}})
            vertices.emplace_back(x, y, z);
    return vertices;
}

std::string obj_cuboid(const openvdb::Vec3d& low, const openvdb::Vec3d& high, int faces = 12, int first_vertex = 0) {
    std::ostringstream text;
    for (const openvdb::Vec3d& v : cuboid_vertices(low, high)) text << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
    for (int f = 0; f < faces; ++f) {
        text << 'f';
        for (const int corner : cuboid_faces[f]) text << ' ' << corner + first_vertex;
        text << '\n';
    }
    return text.str();
}

std::string stl_cuboid(const openvdb::Vec3d& low, const openvdb::Vec3d& high, bool inside_out) {
    std::ostringstream text;
    text << "solid cuboid\n";
    const std::vector<openvdb::Vec3d> vertices = cuboid_vertices(low, high);
    for (const auto& face : cuboid_faces) {
        text << "facet normal 0 0 0\n outer loop\n";
        for (int n = 0; n < 3; ++n) {
            const openvdb::Vec3d& v = vertices[std::size_t(face[inside_out ? 2 - n : n]) - 1];
            text << "  vertex " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
        }
        text << " endloop\nendfacet\n";
    }
    text << "endsolid cuboid\n";
    return text.str();
}

std::string ply_cuboid(const openvdb::Vec3d& low, const openvdb::Vec3d& high) {
    std::ostringstream text;
    text << "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 12\nproperty list uchar int vertex_indices\nend_header\n";
    for (const openvdb::Vec3d& v : cuboid_vertices(low, high)) text << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
    for (const auto& face : cuboid_faces) text << "3 " << face[0] - 1 << ' ' << face[1] - 1 << ' ' << face[2] - 1 << '\n';
    return text.str();
}

std::string base64(const std::string& bytes) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t n = 0; n < bytes.size(); n += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) bits = (bits << 8) | (n + k < bytes.size() ? std::uint8_t(bytes[n + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += n + k <= bytes.size() ? digits[(bits >> (18 - 6 * k)) & 63u] : '=';
    }
    return text;
}

/// The cuboid in a node that moves it by `shift`.
std::string gltf_cuboid(const openvdb::Vec3d& from, const openvdb::Vec3d& to, const openvdb::Vec3d& shift) {
    std::string bytes;
    const auto append = [&bytes](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
    for (const openvdb::Vec3d& v : cuboid_vertices(from, to))
        for (int axis = 0; axis < 3; ++axis) append(float(v[axis]));
    for (const auto& face : cuboid_faces)
        for (const int corner : face) append(std::uint16_t(corner - 1));
    std::ostringstream text;
    text << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[)" << shift.x()
         << ',' << shift.y() << ',' << shift.z()
         << R"(]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
         << R"("accessors":[{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3","min":[)" << from.x() << ',' << from.y()
         << ',' << from.z() << R"(],"max":[)" << to.x() << ',' << to.y() << ',' << to.z()
         << R"(]},{"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}],)"
         << R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":96},{"buffer":0,"byteOffset":96,"byteLength":72}],)"
         << R"("buffers":[{"byteLength":168,"uri":"data:application/octet-stream;base64,)" << base64(bytes) << R"("}]})";
    return text.str();
}

/// The same cuboid as `low`..`high`, seen as a box on the ground.
double cuboid_distance(const openvdb::Vec3d& p, const openvdb::Vec3d& low, const openvdb::Vec3d& high) {
    ShapeRecipe box;
    box.kind = ShapeKind::box;
    const openvdb::Vec3d size = high - low;
    box.size_mm = {size.x(), size.y(), size.z()};
    const openvdb::Vec3d foot(0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()), low.z());
    return make_shape(box)->signed_distance_mm(p - foot);
}

const openvdb::Vec3d low(-1.0, 2.0, 0.5), high(2.0, 4.0, 1.5);

void expect_cuboid(const Shape& shape, const openvdb::Vec3d& from, const openvdb::Vec3d& to) {
    EXPECT_TRUE(shape.bounds_mm().min().eq(from, 1e-6));
    EXPECT_TRUE(shape.bounds_mm().max().eq(to, 1e-6));
    openvdb::BBoxd box(from, to);
    box.expand(0.3 * (to - from).length());
    for (std::uint64_t n = 0; n < 200; ++n) {
        const openvdb::Vec3d p = random_point(box, 2, n);
        ASSERT_NEAR(shape.signed_distance_mm(p), cuboid_distance(p, from, to), 1e-6);
        ASSERT_EQ(shape.contains(p), cuboid_distance(p, from, to) < 0.0);
    }
}

TEST(MeshShape, ReadsObjPlyAndStl) {
    expect_cuboid(*make_mesh_shape(write_test_file("cuboid.obj", obj_cuboid(low, high)), 1.0), low, high);
    expect_cuboid(*make_mesh_shape(write_test_file("cuboid.ply", ply_cuboid(low, high)), 1.0), low, high);
    expect_cuboid(*make_mesh_shape(write_test_file("cuboid.stl", stl_cuboid(low, high, false)), 1.0), low, high);
}

TEST(MeshShape, ReadsGltfWithItsNodesTransforms) {
    const openvdb::Vec3d shift(1.0, -2.0, 0.5);
    expect_cuboid(*make_mesh_shape(write_test_file("cuboid.gltf", gltf_cuboid(low - shift, high - shift, shift)), 1.0), low,
                  high);
}

TEST(MeshShape, TurnsAnInsideOutMeshAround) {
    expect_cuboid(*make_mesh_shape(write_test_file("inside_out.stl", stl_cuboid(low, high, true)), 1.0), low, high);
}

TEST(MeshShape, ScalesToMillimetres) {
    expect_cuboid(*make_mesh_shape(write_test_file("inches.obj", obj_cuboid(low, high)), 25.4), 25.4 * low, 25.4 * high);
}

TEST(MeshShape, LevelSetAgreesWithTheDistanceOnAnyNumberOfThreads) {
    const auto shape = make_mesh_shape(write_test_file("level_set.obj", obj_cuboid(low, high)), 1.0);
    const double h = 0.07;
    const auto one = testing_tools::with_threads(1, [&] { return shape->level_set(h); });
    const auto two = testing_tools::with_threads(2, [&] { return shape->level_set(h); });
    EXPECT_TRUE(testing_tools::same_grids(*one, *two));
    auto values = one->getConstAccessor();
    for (const openvdb::Coord& voxel : openvdb::CoordBBox({-20, 23, 0}, {34, 62, 27})) {
        const double distance = shape->signed_distance_mm(voxel.asVec3d() * h);
        const float stored = values.getValue(voxel);
        ASSERT_EQ(stored < 0.0f, distance < 0.0) << voxel;
        ASSERT_EQ(values.isValueOn(voxel), std::abs(stored) < float(3.0 * h)) << voxel;
        ASSERT_NEAR(stored, std::clamp(distance, -3.0 * h, 3.0 * h), 1e-6) << voxel;
    }
}

TEST(MeshShape, HoldsSitesInSeparateParts) {
    const std::string two = obj_cuboid({0, 0, 0}, {1, 1, 1}) + obj_cuboid({3, 0, 0}, {4, 1, 1}, 12, 8);
    const auto shape = make_mesh_shape(write_test_file("two_parts.obj", two), 1.0);
    const SiteSet sites = sample_sites(*shape, 100, 1);
    const auto in_first =
        std::count_if(sites.positions_mm.begin(), sites.positions_mm.end(), [](const auto& p) { return p.x() < 2.0; });
    EXPECT_NEAR(double(in_first), 50.0, 15.0);
}

TEST(MeshShape, OpenMeshIsRefusedNamingItsHoles) {
    const auto file = write_test_file("open.obj", obj_cuboid(low, high, 10));
    const auto message = input_error_of([&] { make_mesh_shape(file, 1.0); });
    EXPECT_NE(message.find("open.obj: is open, it must be closed: 4 border edges around 1 hole"), std::string::npos) << message;
}

/// The triangles numbered in `flipped` turned around.
std::string with_flipped_faces(const std::string& obj, const std::vector<int>& flipped) {
    std::istringstream lines(obj);
    std::ostringstream turned;
    int face = 0;
    for (std::string line; std::getline(lines, line);) {
        int a, b, c;
        if (std::sscanf(line.c_str(), "f %d %d %d", &a, &b, &c) == 3 &&
            std::find(flipped.begin(), flipped.end(), face++) != flipped.end())
            turned << "f " << c << ' ' << b << ' ' << a << '\n';
        else
            turned << line << '\n';
    }
    return turned.str();
}

TEST(MeshShape, SingleFlippedTrianglesAreTurned) {
    const auto file = write_test_file("flipped.obj", with_flipped_faces(obj_cuboid(low, high), {0, 3, 7, 11}));
    expect_cuboid(*make_mesh_shape(file, 1.0), low, high);
}

/// Inside of one cuboid (6 x 6 x 6, twelve triangles from 0) and another in it or beside it.
std::unique_ptr<Shape> two_cuboids(const openvdb::Vec3d& from, const openvdb::Vec3d& to, const std::vector<int>& flipped) {
    const std::string both = obj_cuboid({0, 0, 0}, {6, 6, 6}) + obj_cuboid(from, to, 12, 8);
    return make_mesh_shape(write_test_file("two_cuboids.obj", with_flipped_faces(both, flipped)), 1.0);
}

const std::vector<int> second_part = {12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23};

TEST(MeshShape, AFlippedPartIsTurned) {
    for (const auto& flipped : {std::vector<int>{}, second_part}) {
        const auto shape = two_cuboids({8, 1, 1}, {9, 2, 2}, flipped);
        EXPECT_TRUE(shape->contains({3.0, 3.0, 3.0}));
        EXPECT_TRUE(shape->contains({8.5, 1.5, 1.5}));
        EXPECT_FALSE(shape->contains({7.0, 1.5, 1.5}));
        EXPECT_NEAR(shape->signed_distance_mm({8.4, 1.5, 1.5}), -0.4, 1e-6);
    }
}

TEST(MeshShape, APartInsideAnotherIsACavityWhicheverWayItFaces) {
    for (const auto& flipped : {std::vector<int>{}, second_part}) {
        const auto shape = two_cuboids({2, 2, 2}, {4, 4, 4}, flipped);
        EXPECT_FALSE(shape->contains({3.0, 3.0, 3.0}));
        EXPECT_NEAR(shape->signed_distance_mm({3.0, 3.0, 3.5}), 0.5, 1e-6);
        EXPECT_NEAR(shape->signed_distance_mm({1.2, 3.0, 3.0}), -0.8, 1e-6);
    }
}

TEST(MeshShape, CrossingPartsAreUnitedWhicheverWayTheyFace) {
    const openvdb::Vec3d from(4, 3, 2), to(9, 8, 7);
    for (const auto& flipped : {std::vector<int>{}, second_part}) {
        const auto shape = two_cuboids(from, to, flipped);
        EXPECT_TRUE(shape->bounds_mm().max().eq({9, 8, 7}, 1e-6));
        openvdb::BBoxd box({0, 0, 0}, {9, 8, 7});
        box.expand(1.0);
        for (std::uint64_t n = 0; n < 2000; ++n) {
            const openvdb::Vec3d p = random_point(box, 3, n);
            const double first = cuboid_distance(p, {0, 0, 0}, {6, 6, 6}), second = cuboid_distance(p, from, to);
            ASSERT_EQ(shape->contains(p), std::min(first, second) < 0.0) << p;
            if (std::min(first, second) < 0.0) continue;
            // Outside, the nearest place of a union is the nearer of the parts'.
            ASSERT_NEAR(shape->signed_distance_mm(p), std::min(first, second), 1e-6) << p;
        }
    }
}

TEST(MeshShape, PartsThatTouchInAFaceAreUnited) {
    const auto shape = two_cuboids({6, 1, 1}, {8, 5, 5}, {});
    EXPECT_TRUE(shape->contains({6.0, 3.0, 3.0}));
    EXPECT_NEAR(shape->signed_distance_mm({6.5, 3.0, 3.0}), -1.5, 1e-6);
}

TEST(MeshShape, APartThatCrossesItselfIsRefusedNamingPlaces) {
    // One corner is pulled through the opposite side.
    std::string pulled = obj_cuboid({0, 0, 0}, {2, 2, 2});
    const std::size_t corner = pulled.find("v 2 2 2");
    pulled.replace(corner, 7, "v -3 -2 -2.5");
    const auto message = input_error_of([&] { make_mesh_shape(write_test_file("pulled.obj", pulled), 1.0); });
    EXPECT_NE(message.find("pulled.obj: intersects itself"), std::string::npos) << message;
    EXPECT_NE(message.find("of one part cross, near ("), std::string::npos) << message;
}

TEST(MeshShape, EveryHoleIsNamed) {
    // The face x = 2 and a triangle of the face x = 0 are missing.
    std::string open = obj_cuboid({0, 0, 0}, {2, 2, 2}, 10);
    open.erase(open.find("f 1 5 8\n"), 8);
    const auto message = input_error_of([&] { make_mesh_shape(write_test_file("holes.obj", open), 1.0); });
    EXPECT_NE(message.find("7 border edges around 2 holes at ("), std::string::npos) << message;
}

TEST(MeshShape, FilesThatAreNoMeshAreRefused) {
    const auto error_for = [](const std::string& file) { return input_error_of([&] { make_mesh_shape(file, 1.0); }); };
    EXPECT_NE(error_for("/nowhere/gem.obj").find("/nowhere/gem.obj: no such file"), std::string::npos);
    EXPECT_NE(error_for(write_test_file("gem.txt", "x")).find("not a kind of file that can be read"), std::string::npos);
    EXPECT_NE(error_for(write_test_file("empty.obj", "")).find("empty.obj: cannot be read"), std::string::npos);
    EXPECT_NE(error_for(write_test_file("garbage.ply", "no polygons in here")).find("garbage.ply: cannot be read"),
              std::string::npos);
    EXPECT_NE(error_for(write_test_file("garbage.stl", std::string(300, '\x07'))).find("garbage.stl"), std::string::npos);
    EXPECT_NE(error_for(write_test_file("garbage.glb", std::string(300, '\x07'))).find("garbage.glb: cannot be read"),
              std::string::npos);
    EXPECT_NE(error_for(write_test_file("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")).find("points.obj"), std::string::npos);
    EXPECT_NE(error_for(write_test_file("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n")).find("flat.obj"),
              std::string::npos);
}

/// What a library of mesh readers would not come back from.
TEST(MeshShape, DamagedPlyIsRefused) {
    const std::string good = ply_cuboid({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0});
    const auto error_with = [&](const std::string& from, const std::string& to) {
        std::string text = good;
        text.replace(text.find(from), from.size(), to);
        const std::string file = write_test_file("damaged.ply", text);
        return input_error_of([&] { read_mesh_file(file, 1.0); });
    };
    EXPECT_NE(error_with("end_header", "end_headr").find("its header does not end"), std::string::npos);
    EXPECT_NE(error_with("vertex 8", "vertex 80000000").find("states '80000000' elements 'vertex'"), std::string::npos);
    EXPECT_NE(error_with("vertex 8", "99999999 8").find("states '8' elements '99999999'"), std::string::npos);
    EXPECT_NE(error_with("\n3 ", "\n3 3000000000 ").find("damaged.ply"), std::string::npos);
    EXPECT_NE(error_with("\n3 ", "\n ").find("damaged.ply"), std::string::npos);
}

}  // namespace
}  // namespace opal
