// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "formats/random.h"
#include "renderer/cpu/embree_scene.h"
#include "renderer/host/mesh_topology.h"
#include "renderer/host/patch_surface.h"
#include "round_body.h"

namespace opal {
namespace {

struct Place {
    long double p[3];
};

/// S by de Casteljau's algorithm in long double, and its derivatives by those of the control points.
Place casteljau(const BezierPatch& patch, long double u, long double v, int derivative) {
    long double rows[4][3];
    const auto collapse = [](long double(&c)[4][3], long double t, bool derived, long double(&out)[3]) {
        int count = 4;
        if (derived) {
            for (int i = 0; i < 3; ++i)
                for (int axis = 0; axis < 3; ++axis) c[i][axis] = 3.0L * (c[i + 1][axis] - c[i][axis]);
            count = 3;
        }
        for (; count > 1; --count)
            for (int i = 0; i + 1 < count; ++i)
                for (int axis = 0; axis < 3; ++axis) c[i][axis] += t * (c[i + 1][axis] - c[i][axis]);
        for (int axis = 0; axis < 3; ++axis) out[axis] = c[0][axis];
    };
    for (int i = 0; i < 4; ++i) {
        long double column[4][3];
        for (int j = 0; j < 4; ++j)
            for (int axis = 0; axis < 3; ++axis) column[j][axis] = patch.control_mm[i][j][axis];
        collapse(column, v, derivative == 2, rows[i]);
    }
    Place place;
    collapse(rows, u, derivative == 1, place.p);
    return place;
}

long double dot(const Place& a, const Place& b) {
    return a.p[0] * b.p[0] + a.p[1] * b.p[1] + a.p[2] * b.p[2];
}
Place cross(const Place& a, const Place& b) {
    return {{a.p[1] * b.p[2] - a.p[2] * b.p[1], a.p[2] * b.p[0] - a.p[0] * b.p[2], a.p[0] * b.p[1] - a.p[1] * b.p[0]}};
}

/// Distance along the ray of its meeting with the patch near (u, v): Gauss-Newton for S = o + t d in all three components.
long double reference_distance(const BezierPatch& patch, const Ray& ray, long double u, long double v) {
    const Place d{{ray.direction.x, ray.direction.y, ray.direction.z}};
    long double t = 0.0L;
    for (int step = 0; step < 30; ++step) {
        const Place s = casteljau(patch, u, v, 0), su = casteljau(patch, u, v, 1), sv = casteljau(patch, u, v, 2);
        const Place r{{s.p[0] - ray.origin.x, s.p[1] - ray.origin.y, s.p[2] - ray.origin.z}};
        // u' su + v' sv - t d = -r by Cramer's rule.
        const long double determinant = dot(cross(su, sv), d);
        t = dot(cross(su, sv), r) / determinant;
        u -= dot(cross(r, sv), d) / determinant;
        v -= dot(cross(su, r), d) / determinant;
    }
    return t;
}

Vec3 random_direction(std::uint64_t index) {
    const RandomBlock block = random_block(3, RandomStream::bench, index, 0);
    const float z = 2.0f * uniform_float(block.value[0]) - 1.0f, angle_rad = 2.0f * pi_f * uniform_float(block.value[1]);
    const float r = std::sqrt(1.0f - z * z);
    return {r * std::cos(angle_rad), r * std::sin(angle_rad), z};
}

TEST(BezierHits, SurfaceIsClosedAndOutward) {
    RigidTransform transform;
    transform.origin = {1.0f, -2.0f, 3.0f};
    transform.scale = 2.0f;
    const std::vector<MeshData> meshes = surfaces_from_patches(round_body(3.0, 2.0, 1.0), transform);
    ASSERT_EQ(meshes.size(), 1u);
    EXPECT_EQ(count_open_edges(meshes[0]), 0u);
    EXPECT_NEAR(signed_volume6(meshes[0]) / 6.0, 8.0 * 4.0 / 3.0 * double(pi_f) * 6.0, 0.3);
}

/// From outside and from inside, near the outline as well: distance to a millionth of a millimetre of the root in long double,
/// the normal to a microradian. Rounding of the ray's own floats is not part of it: the reference takes the same floats.
TEST(BezierHits, AgreeWithRootsInLongDouble) {
    const std::vector<BezierPatch> patches = round_body(3.0, 2.0, 1.0);
    const std::vector<MeshData> meshes = surfaces_from_patches(patches, {});
    const EmbreeScene scene(meshes);
    int hits = 0;
    for (std::uint64_t i = 0; i < 20'000; ++i) {
        Ray ray;
        ray.direction = normalize(random_direction(2 * i));
        const Vec3 aim = random_direction(2 * i + 1);
        ray.origin = Vec3{2.9f * aim.x, 1.9f * aim.y, 0.9f * aim.z} - (i % 2 == 0 ? 8.0f : 0.0f) * ray.direction;
        RayHit hit;
        if (!scene.closest(ray, hit)) continue;
        ++hits;
        const BezierPatch& patch = meshes[0].patches[meshes[0].pieces[hit.triangle].patch];
        const BezierPoint point = evaluate_bezier(patch, double(hit.u), double(hit.v));
        const double cosine = std::abs(point.normal[0] * double(ray.direction.x) + point.normal[1] * double(ray.direction.y) +
                                       point.normal[2] * double(ray.direction.z));
        // Near the outline distances are ill defined.
        if (cosine < 0.02) continue;
        const double expected = double(reference_distance(patch, ray, hit.u, hit.v));
        EXPECT_NEAR(double(hit.distance_mm), expected, 1.0e-6 + 6.0e-8 * expected / cosine) << i;
        // An ellipsoid by cubic arcs is off by 3e-4 of its radius: its normal is checked against the patch's own tangents.
        const Place normal = cross(casteljau(patch, hit.u, hit.v, 1), casteljau(patch, hit.u, hit.v, 2));
        const long double size = std::sqrt(dot(normal, normal));
        for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(point.normal[axis], double(normal.p[axis] / size), 1.0e-6) << i;
    }
    EXPECT_GT(hits, 12'000);
}

/// A ray that starts on the surface and goes in does not meet it there again, and leaves on the other side.
TEST(BezierHits, RaysFromTheSurfacePassThrough) {
    const std::vector<MeshData> meshes = surfaces_from_patches(round_body(3.0, 2.0, 1.0), {});
    const EmbreeScene scene(meshes);
    std::vector<MeshView> views = {meshes[0].view()};
    SceneView view;
    view.meshes = views.data();
    for (std::uint64_t i = 0; i < 5'000; ++i) {
        const Vec3 direction = normalize(random_direction(i));
        Ray ray{-5.0f * direction, direction};
        RayHit hit;
        ASSERT_TRUE(scene.closest(ray, hit));
        const Surface in = surface_at(view, hit);
        EXPECT_LT(dot(in.geometric_normal, direction), 0.0f);
        ray.origin = offset_origin(in.position, in.geometric_normal, direction);
        ASSERT_TRUE(scene.closest(ray, hit)) << i;
        const Surface out = surface_at(view, hit);
        EXPECT_GT(dot(out.geometric_normal, direction), 0.0f) << i;
        EXPECT_GT(hit.distance_mm, 1.9f) << i;
        // The body is its own mirror image; the start was moved along the normal.
        const float moved_mm = 4.0e-6f * (1.0f + 3.0f);
        EXPECT_NEAR(length(out.position + in.position), 0.0f, moved_mm / dot(out.geometric_normal, direction) + 2.0e-6f) << i;
        ray.origin = offset_origin(out.position, out.geometric_normal, direction);
        EXPECT_FALSE(scene.closest(ray, hit)) << i;
    }
}

/// A chord along the surface, however short: light that runs around just beneath it is turned back every time, and stays inside
/// for as many turns as there are. (Near triangles such chords pass between triangles and surface.)
TEST(BezierHits, ShortChordsStayInside) {
    for (const double place_mm : {0.0, 1000.0}) {
        RigidTransform transform;
        transform.origin = {float(place_mm), 0.0f, 0.0f};
        const std::vector<MeshData> meshes = surfaces_from_patches(round_body(3.0, 2.0, 1.0), transform);
        const EmbreeScene scene(meshes);
        std::vector<MeshView> views = {meshes[0].view()};
        SceneView view;
        view.meshes = views.data();
        int turns = 0;
        for (std::uint64_t i = 0; i < 200; ++i) {
            const Vec3 aim = normalize(random_direction(i));
            Ray ray{transform.origin, aim};
            RayHit hit;
            ASSERT_TRUE(scene.closest(ray, hit));
            Surface at = surface_at(view, hit);
            // Beneath the surface by angles from 1e-3 to 1e-1.
            const float angle = std::pow(10.0f, -1.0f - 2.0f * float(i % 50) / 49.0f);
            Vec3 direction = normalize(Frame(at.geometric_normal).tangent - angle * at.geometric_normal);
            for (int turn = 0; turn < 100; ++turn, ++turns) {
                ray = {offset_origin(at.position, at.geometric_normal, direction), direction};
                ASSERT_TRUE(scene.closest(ray, hit)) << place_mm << " " << i << " " << turn;
                at = surface_at(view, hit);
                ASSERT_GT(dot(at.geometric_normal, direction), 0.0f) << place_mm << " " << i << " " << turn;
                direction = normalize(mirror(direction, at.geometric_normal));
            }
        }
        EXPECT_EQ(turns, 20'000);
    }
}

/// Rays within a part in a thousand of the outline, on either side of it: they miss the solid, or go in and out of it.
TEST(BezierHits, EveryRayGoesInAndOut) {
    const std::vector<MeshData> meshes = surfaces_from_patches(round_body(3.0, 2.0, 1.0), {});
    const EmbreeScene scene(meshes);
    std::vector<MeshView> views = {meshes[0].view()};
    SceneView view;
    view.meshes = views.data();
    int grazing = 0;
    for (std::uint64_t i = 0; i < 20'000; ++i) {
        const Vec3 side = normalize(random_direction(2 * i)), along = normalize(cross(side, random_direction(2 * i + 1)));
        // The ellipsoid's support in the direction `side`, across `along`.
        const Vec3 scaled{3.0f * side.x, 2.0f * side.y, side.z};
        const float reach = length(scaled) * (1.0f + 1.0e-3f * (float(i % 21) - 10.0f) / 10.0f);
        const Vec3 touch = (1.0f / length(scaled)) * Vec3{9.0f * side.x, 4.0f * side.y, side.z};
        Ray ray{touch + (reach - length(scaled)) * side - 10.0f * along, along};
        RayHit hit;
        if (!scene.closest(ray, hit)) continue;
        Surface at = surface_at(view, hit);
        ASSERT_LT(dot(at.geometric_normal, along), 0.0f) << i;
        ray.origin = offset_origin(at.position, at.geometric_normal, along);
        if (-dot(at.geometric_normal, along) < 0.02f) ++grazing;
        // A chord shorter than the move of its start may be skipped as a whole.
        if (-dot(at.geometric_normal, along) < 0.01f) continue;
        ASSERT_TRUE(scene.closest(ray, hit)) << i;
        at = surface_at(view, hit);
        ASSERT_GT(dot(at.geometric_normal, along), 0.0f) << i;
        ray.origin = offset_origin(at.position, at.geometric_normal, along);
        ASSERT_FALSE(scene.closest(ray, hit)) << i;
    }
    EXPECT_GT(grazing, 100);
}

}  // namespace
}  // namespace opal
