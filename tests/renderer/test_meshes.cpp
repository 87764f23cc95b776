// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>

#include "../formats/expect_error.h"
#include "renderer/host/mesh_file.h"
#include "renderer/host/mesh_topology.h"
#include "small_opal.h"

namespace opal {
namespace {

/// A unit cube whose twelve triangles share their eight vertices.
const char* const cube_obj =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

std::filesystem::path write(const ScratchFolder& folder, const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return folder / name;
}

MeshData load(const std::filesystem::path& path, std::optional<double> smooth_deg = {}) {
    std::vector<std::string> notices;
    return load_mesh(path, smooth_deg, notices);
}

TEST(Meshes, OpenEdgesAreCounted) {
    EXPECT_EQ(count_open_edges(make_sphere(2.0)), 0u);
    EXPECT_EQ(count_open_edges(make_cylinder(2.0, 1.0, 0.1)), 0u);
    EXPECT_EQ(count_open_edges(make_plane(1.0)), 4u);
    EXPECT_NEAR(signed_volume6(make_sphere(2.0)) / 6.0, 4.0 / 3.0 * double(pi_f) * 8.0, 0.01);
    const ScratchFolder folder;
    MeshData cube = load(write(folder, "cube.obj", cube_obj));
    EXPECT_EQ(count_open_edges(cube), 0u);
    EXPECT_NEAR(signed_volume6(cube), 6.0, 1.0e-6);
    turn_inside_out(cube);
    EXPECT_NEAR(signed_volume6(cube), -6.0, 1.0e-6);
    EXPECT_EQ(count_open_edges(cube), 0u);
    cube.indices.resize(cube.indices.size() - 3);
    EXPECT_EQ(count_open_edges(cube), 3u);
}

/// At a corner of a cube a crease angle below 90 degrees keeps the faces apart; above it all three are smoothed.
TEST(Meshes, CreaseAngleDecidesWhatIsSmooth) {
    const ScratchFolder folder;
    const std::filesystem::path path = write(folder, "cube.obj", cube_obj);
    EXPECT_TRUE(load(path).normals.empty());
    for (const double crease_deg : {0.0, 60.0}) {
        const MeshData flat = load(path, crease_deg);
        for (std::size_t i = 0; i < flat.indices.size(); ++i) {
            const std::uint32_t* corner = flat.indices.data() + 3 * (i / 3);
            const Vec3 a = flat.positions[corner[0]];
            const Vec3 face = normalize(cross(flat.positions[corner[1]] - a, flat.positions[corner[2]] - a));
            EXPECT_NEAR(dot(flat.normals[flat.indices[i]], face), 1.0f, 1.0e-6f);
        }
    }
    const MeshData smooth = load(path, 100.0);
    for (std::size_t i = 0; i < smooth.positions.size(); ++i) {
        // Each face counts by its angle of 90 degrees, however it is cut into triangles.
        const Vec3 outward = normalize(smooth.positions[i] - Vec3{0.5f, 0.5f, 0.5f});
        EXPECT_NEAR(dot(smooth.normals[i], outward), 1.0f, 1.0e-6f);
    }
}

TEST(Meshes, NormalsOfTheFileAreKept) {
    const ScratchFolder folder;
    const MeshData mesh = load(write(folder, "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 2\nvn 1 0 1\nf 1//1 2//2 3//1\n"));
    ASSERT_EQ(mesh.normals.size(), 3u);
    float tilted = 0.0f;
    for (const Vec3& normal : mesh.normals) {
        EXPECT_NEAR(length(normal), 1.0f, 1.0e-6f);
        tilted = std::max(tilted, normal.x);
    }
    EXPECT_NEAR(tilted, std::sqrt(0.5f), 1.0e-6f);
}

TEST(Meshes, GroupsAreOneWithANotice) {
    const ScratchFolder folder;
    write(folder, "m.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    std::vector<std::string> notices;
    const MeshData mesh = load_mesh(
        write(folder, "two.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nusemtl red\nf 1 2 3\nusemtl blue\nf 2 4 3\n"),
        {}, notices);
    EXPECT_EQ(mesh.indices.size(), 6u);
    ASSERT_EQ(notices.size(), 1u);
    EXPECT_NE(notices[0].find("materials of their own"), std::string::npos);
}

TEST(Meshes, PlyAndStl) {
    const ScratchFolder folder;
    const MeshData ply =
        load(write(folder, "t.ply",
                   "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                   "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
    EXPECT_EQ(ply.indices.size(), 3u);
    const MeshData stl = load(write(folder, "t.stl",
                                    "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                                    "endfacet\nendsolid t\n"));
    EXPECT_EQ(stl.indices.size(), 3u);
}

TEST(Meshes, ADielectricMustBeClosed) {
    const ScratchFolder folder;
    const std::string open = std::string(cube_obj).substr(0, std::string(cube_obj).rfind("f 4"));
    const std::string path = write(folder, "open.obj", open).string();
    const std::string scene =
        "[[material]]\nname = \"glass\"\nkind = \"dielectric\"\n[[object]]\nkind = \"mesh\"\nmaterial = \"glass\"\n"
        "file = '" +
        path + "'\n";
    EXPECT_INPUT_ERROR(render_text(scene, 1),
                       "open.obj: the surface has 4 open edges; a dielectric ('glass') needs a closed one");
    EXPECT_INPUT_ERROR(load(write(folder, "bad.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n")), "bad.obj: ");
    EXPECT_INPUT_ERROR(load(folder / "none.obj"), "no such mesh file");
}

}  // namespace
}  // namespace opal
