// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <cstring>

#include "bvh_comparison.h"

namespace opal {
namespace {

/// Nothing but rounding lies between them (the tolerances are derived in bvh_comparison.cpp).
TEST(Bvh, MeetsWhatEmbreeMeets) {
    for (const ComparedScene& scene : compared_scenes()) {
        const Bvh bvh(scene.meshes);
        const std::vector<MeshView> views = views_of(scene.meshes);
        const EmbreeScene embree(scene.meshes);
        const std::uint64_t rays = scene.exact ? 20'000 : 245'000;
        const BvhComparison result = compare_with_embree(scene, bvh.view<true>(views.data()), embree, 0, rays);
        EXPECT_EQ(result.unexplained, 0u) << scene.name << ": ray " << result.first_unexplained;
        EXPECT_EQ(result.wrong_occlusion, 0u) << scene.name;
        EXPECT_EQ(result.same + result.ties + result.at_start + result.at_border + result.edge_on, rays) << scene.name;
        EXPECT_GT(result.met, rays / 5) << scene.name << ": too few to say anything";
    }
}

/// Rays from within a closed surface always meet it: in its triangles, on their edges and at their corners.
TEST(Bvh, IsWatertight) {
    for (const ComparedScene& scene : compared_scenes()) {
        if (!scene.closed) continue;
        const Bvh bvh(scene.meshes);
        const std::vector<MeshView> views = views_of(scene.meshes);
        const BvhView<true> view = bvh.view<true>(views.data());
        for (std::uint64_t i = 0; i < 100'000; ++i) {
            const RayKind kind = std::array{RayKind::to_edge, RayKind::to_corner, RayKind::from_inside}[i % 3];
            Ray ray = compared_ray(scene, kind, 2 * i + 1);  // odd ones start near the middle
            if (kind == RayKind::from_inside) ray.origin = 0.1f * ray.origin;
            RayHit hit;
            EXPECT_TRUE(view.closest(ray, hit)) << scene.name << " " << i;
            EXPECT_TRUE(view.occluded(ray, 10.0f * scene.radius_mm)) << scene.name << " " << i;
        }
        // Square to the axes, from outside and exactly through a corner.
        for (std::uint64_t i = 0; i < 30'000; ++i) {
            const Vec3 corner = compared_corner(scene, i);
            for (const Ray& ray :
                 {Ray{{-20.0f, corner.y, corner.z}, {1.0f, 0.0f, 0.0f}}, Ray{{corner.x, 20.0f, corner.z}, {0.0f, -1.0f, 0.0f}},
                  Ray{{corner.x, corner.y, -20.0f}, {0.0f, 0.0f, 1.0f}}}) {
                RayHit hit;
                ASSERT_TRUE(view.closest(ray, hit)) << scene.name << " " << i;
                EXPECT_LE(hit.distance_mm, 20.0f + dot(corner, ray.direction) + 1.0e-5f) << scene.name << " " << i;
            }
        }
    }
}

/// Rays from outside enter a ball through its front, on all edges and corners of its triangles: what they first meet faces them,
/// but for the few triangles about the outline.
TEST(Bvh, RaysEnterThroughTheFront) {
    const std::vector<ComparedScene> scenes = compared_scenes();
    const ComparedScene& scene = scenes[3];
    ASSERT_TRUE(scene.closed);
    const Bvh bvh(scene.meshes);
    const std::vector<MeshView> views = views_of(scene.meshes);
    const BvhView<true> view = bvh.view<true>(views.data());
    SceneView surfaces;
    surfaces.meshes = views.data();
    int met = 0;
    for (std::uint64_t i = 0; i < 100'000; ++i) {
        const Ray ray =
            compared_ray(scene, i % 2 == 0 ? RayKind::to_edge : RayKind::to_corner, 2 * i);  // even ones start outside
        RayHit hit;
        if (!view.closest(ray, hit)) continue;
        ++met;
        EXPECT_LT(dot(surface_at(surfaces, hit).geometric_normal, ray.direction), 0.05f) << i;
    }
    EXPECT_GT(met, 99'000);
}

TEST(Bvh, IsTheSameOnAnyNumberOfThreads) {
    const ComparedScene scene = compared_scenes().front();
    const auto built_by = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return Bvh(scene.meshes);
    };
    const Bvh one = built_by(1), four = built_by(4);
    ASSERT_EQ(one.nodes().size(), four.nodes().size());
    ASSERT_EQ(one.primitives().size(), four.primitives().size());
    EXPECT_EQ(one.root().bits, four.root().bits);
    for (std::size_t i = 0; i < one.nodes().size(); ++i)
        for (int child = 0; child < 2; ++child) {
            EXPECT_EQ(one.nodes()[i].child[child].bits, four.nodes()[i].child[child].bits);
            EXPECT_EQ(std::memcmp(&one.nodes()[i].low[child], &four.nodes()[i].low[child], sizeof(Vec3)), 0);
            EXPECT_EQ(std::memcmp(&one.nodes()[i].high[child], &four.nodes()[i].high[child], sizeof(Vec3)), 0);
        }
    for (std::size_t i = 0; i < one.primitives().size(); ++i) EXPECT_EQ(one.primitives()[i].index, four.primitives()[i].index);
}

/// Every primitive once, within the bounds of all nodes above it; no more levels than a walk can remember.
TEST(Bvh, HoldsEverythingOnce) {
    for (const ComparedScene& scene : compared_scenes()) {
        const Bvh bvh(scene.meshes);
        std::vector<std::vector<int>> seen;
        for (const MeshData& mesh : scene.meshes)
            seen.emplace_back(mesh.patches.empty() ? mesh.indices.size() / 3 : mesh.pieces.size(), 0);
        for (const BvhPrimitive& primitive : bvh.primitives()) ++seen[primitive.mesh][primitive.index];
        for (const std::vector<int>& mesh : seen)
            for (const int times : mesh) ASSERT_EQ(times, 1) << scene.name;
        EXPECT_LE(bvh.depth(), bvh_max_depth) << scene.name;
        for (const BvhNode& node : bvh.nodes())
            for (int side = 0; side < 2; ++side) {
                if (!node.child[side].is_leaf()) continue;
                for (std::uint32_t i = 0; i < node.child[side].count(); ++i) {
                    const BvhPrimitive& primitive = bvh.primitives()[node.child[side].first() + i];
                    if (primitive.is_piece != 0) continue;
                    for (const Vec3& p : primitive.corner)
                        ASSERT_TRUE(p.x >= node.low[side].x && p.y >= node.low[side].y && p.z >= node.low[side].z &&
                                    p.x <= node.high[side].x && p.y <= node.high[side].y && p.z <= node.high[side].z)
                            << scene.name;
                }
            }
    }
}

/// A thousand triangles in one place, which no box tells apart, and none at all.
TEST(Bvh, CoincidentTrianglesAndEmptyScenes) {
    MeshData mesh;
    mesh.positions = {{-1.0f, -1.0f, 0.0f}, {1.0f, -1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
    for (int i = 0; i < 1000; ++i) mesh.indices.insert(mesh.indices.end(), {0u, 1u, 2u});
    const Ray down{{0.0f, 0.0f, 2.0f}, {0.0f, 0.0f, -1.0f}}, up{{0.0f, 0.0f, 2.0f}, {0.0f, 0.0f, 1.0f}};
    RayHit hit;
    for (const std::size_t indices : {std::size_t(0), std::size_t(3), mesh.indices.size()}) {
        std::vector<MeshData> meshes = {mesh};
        meshes[0].indices.resize(indices);
        const Bvh bvh(meshes);
        const std::vector<MeshView> views = views_of(meshes);
        const BvhView<true> view = bvh.view<true>(views.data());
        EXPECT_FALSE(view.closest(up, hit));
        EXPECT_FALSE(view.occluded(up, 10.0f));
        ASSERT_EQ(view.closest(down, hit), indices > 0);
        EXPECT_EQ(view.occluded(down, 2.5f), indices > 0);
        EXPECT_FALSE(view.occluded(down, 1.5f));
        EXPECT_TRUE(indices == 0 || hit.distance_mm == 2.0f) << hit.distance_mm;
    }
    EXPECT_FALSE(Bvh({}).view<true>(nullptr).closest(down, hit));
}

}  // namespace
}  // namespace opal
