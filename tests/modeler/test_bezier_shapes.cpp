// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "modeler/bezier_bounds.h"
#include "modeler/bezier_cabochon.h"
#include "modeler/bezier_teapot.h"
#include "modeler/bezier_tessellation.h"
#include "modeler/build.h"
#include "modeler/mesh_distance.h"
#include "modeler/mesh_shape.h"
#include "modeler/mesh_solid.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

using openvdb::Vec3d;
using testing_tools::random_point;

Vec3d position(const BezierPatch& patch, double u, double v) {
    return Vec3d(evaluate_bezier(patch, u, v).position_mm);
}

std::vector<BezierPatch> part_of(const std::vector<BezierPatch>& patches, int part) {
    std::vector<BezierPatch> found;
    std::copy_if(patches.begin(), patches.end(), std::back_inserter(found), [&](const auto& p) { return p.part == part; });
    return found;
}

double enclosed_volume_mm3(const TriangleMesh& mesh) {
    double sum = 0.0;
    for (const openvdb::Vec3I& t : mesh.triangles)
        sum += mesh.vertices_mm[t[0]].dot(mesh.vertices_mm[t[1]].cross(mesh.vertices_mm[t[2]])) / 6.0;
    return sum;
}

/// Whether each directed edge between two places occurs once, and once the other way: closed, without cracks, facing one way.
bool is_watertight(const TriangleMesh& mesh) {
    std::map<std::pair<Vec3d, Vec3d>, int> edges;
    for (const openvdb::Vec3I& t : mesh.triangles)
        for (int n = 0; n < 3; ++n) ++edges[{mesh.vertices_mm[t[n]], mesh.vertices_mm[t[(n + 1) % 3]]}];
    for (const auto& [edge, count] : edges) {
        const auto opposite = edges.find({edge.second, edge.first});
        if (count != 1 || opposite == edges.end()) return false;
    }
    return !edges.empty();
}

const Vec3d gem_mm(12.0, 9.0, 4.5);
constexpr double gem_girdle_mm = 1.2;

TEST(BezierCabochon, IsSmoothAcrossAllEdges) {
    const std::vector<BezierPatch> patches = bezier_cabochon(gem_mm, gem_girdle_mm);
    ASSERT_EQ(patches.size(), 8u);
    const double ratio = (gem_mm.z() - gem_girdle_mm) / gem_girdle_mm;
    for (std::size_t q = 0; q < 4; ++q)
        for (double t = 0.0; t <= 1.0; t += 0.125) {
            for (const std::size_t side : {std::size_t(0), std::size_t(4)}) {
                // Meridians: same place, same tangent across, in length too; same tangent along.
                const BezierPoint left = evaluate_bezier(patches[side + q], t, 1.0);
                const BezierPoint right = evaluate_bezier(patches[side + (q + 1) % 4], t, 0.0);
                for (int axis = 0; axis < 3; ++axis) {
                    EXPECT_NEAR(left.position_mm[axis], right.position_mm[axis], 1e-14);
                    EXPECT_NEAR(left.dv_mm[axis], right.dv_mm[axis], 1e-13);
                    EXPECT_NEAR(left.du_mm[axis], right.du_mm[axis], 1e-13);
                    EXPECT_NEAR(left.normal[axis], right.normal[axis], 1e-14);
                }
            }
            // The girdle: same place, tangents across it in the ratio of the heights.
            const BezierPoint above = evaluate_bezier(patches[q], 1.0, t), below = evaluate_bezier(patches[4 + q], 0.0, t);
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_NEAR(above.position_mm[axis], below.position_mm[axis], 1e-14);
                EXPECT_NEAR(above.du_mm[axis], ratio * below.du_mm[axis], 1e-13);
                EXPECT_NEAR(above.dv_mm[axis], below.dv_mm[axis], 1e-13);
                EXPECT_NEAR(above.normal[axis], below.normal[axis], 1e-14);
            }
            // The poles: every patch has the vertical as its normal.
            EXPECT_NEAR(evaluate_bezier(patches[q], 0.0, t).normal[2], 1.0, 1e-14);
            EXPECT_NEAR(evaluate_bezier(patches[4 + q], 1.0, t).normal[2], -1.0, 1e-14);
        }
}

TEST(BezierCabochon, IsTwoHalfEllipsoidsToTheStatedError) {
    const std::vector<BezierPatch> patches = bezier_cabochon(gem_mm, gem_girdle_mm);
    const openvdb::BBoxd bounds = bezier_bounds_mm(patches);
    EXPECT_TRUE(bounds.extents().eq(gem_mm, 1e-12));
    EXPECT_NEAR(bounds.min().z(), 0.0, 1e-12);
    double outline_error = 0.0, solid_error = 0.0, least = 1.0;
    for (std::size_t n = 0; n < 8; ++n) {
        const double height = n < 4 ? gem_mm.z() - gem_girdle_mm : gem_girdle_mm;
        for (int i = 0; i <= 200; ++i)
            for (int j = 0; j <= 200; ++j) {
                const Vec3d p = position(patches[n], i / 200.0, j / 200.0);
                const Vec3d unit(p.x() / 6.0, p.y() / 4.5, (p.z() - gem_girdle_mm) / height);
                solid_error = std::max(solid_error, unit.length() - 1.0);
                least = std::min(least, unit.length());
                if (n < 4 && i == 200) outline_error = std::max(outline_error, unit.length() - 1.0);
            }
    }
    EXPECT_NEAR(outline_error, 2.725e-4, 0.005e-4);  // the known error of the cubic quarter circle
    EXPECT_LT(solid_error, 2.0 * 2.73e-4);
    EXPECT_GT(least, 1.0 - 1e-12);
}

TEST(BezierCabochon, MayHaveAFlatBase) {
    const std::vector<BezierPatch> patches = bezier_cabochon(gem_mm, 0.0);
    for (std::size_t n = 4; n < 8; ++n) EXPECT_EQ(evaluate_bezier(patches[n], 0.3, 0.6).normal[2], -1.0);
    EXPECT_TRUE(is_watertight(tessellate(patches, 0.01)));
}

/// Largest distance between places of equal parameters on the patch and on its triangles, which bounds the distance of each from
/// the other; and the largest true distance from the patch to its triangles.
struct MeasuredError {
    double same_parameters_mm = 0.0;
    double true_mm = 0.0;
};

MeasuredError measure(const BezierPatch& patch, const PatchSplit& split) {
    TriangleMesh mesh;
    for (int i = 0; i <= split.along_u; ++i)
        for (int j = 0; j <= split.along_v; ++j)
            mesh.vertices_mm.push_back(position(patch, double(i) / split.along_u, double(j) / split.along_v));
    const auto vertex = [&](int i, int j) { return static_cast<std::uint32_t>(i * (split.along_v + 1) + j); };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const auto& v = mesh.vertices_mm;
        if (!v[a].eq(v[b]) && !v[b].eq(v[c]) && !v[c].eq(v[a])) mesh.triangles.emplace_back(a, b, c);
    };
    for (int i = 0; i < split.along_u; ++i)
        for (int j = 0; j < split.along_v; ++j) {
            add(vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1));
            add(vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1));
        }
    const MeshDistance distance(mesh);
    MeasuredError error;
    constexpr int samples = 6;
    for (int i = 0; i < split.along_u * samples; ++i)
        for (int j = 0; j < split.along_v * samples; ++j) {
            const double s = (i % samples + 0.5) / samples, t = (j % samples + 0.5) / samples;
            const int row = i / samples, column = j / samples;
            const Vec3d a = mesh.vertices_mm[vertex(row, column)], b = mesh.vertices_mm[vertex(row + 1, column)],
                        c = mesh.vertices_mm[vertex(row + 1, column + 1)], d = mesh.vertices_mm[vertex(row, column + 1)];
            const Vec3d flat = s >= t ? a + s * (b - a) + t * (c - b) : a + t * (d - a) + s * (c - d);
            const Vec3d curved = position(patch, (row + s) / split.along_u, (column + t) / split.along_v);
            error.same_parameters_mm = std::max(error.same_parameters_mm, (curved - flat).length());
            error.true_mm = std::max(error.true_mm, (distance.nearest_point_mm(curved) - curved).length());
        }
    return error;
}

TEST(BezierTessellation, StaysWithinTheChordError) {
    const std::vector<std::vector<BezierPatch>> shapes = {bezier_cabochon(gem_mm, gem_girdle_mm), bezier_teapot(20.0)};
    for (const double chord_error_mm : {0.2, 0.02})
        for (const auto& patches : shapes) {
            const std::vector<PatchSplit> splits = split_patches(patches, chord_error_mm);
            double largest_mm = 0.0, largest_true_mm = 0.0;
            for (std::size_t n = 0; n < patches.size(); ++n) {
                const double bound_mm = chord_error_bound_mm(patches[n], splits[n]);
                EXPECT_LE(bound_mm, chord_error_mm * (1.0 + 1e-12)) << n;
                const MeasuredError error = measure(patches[n], splits[n]);
                EXPECT_LE(error.same_parameters_mm, bound_mm) << n;
                EXPECT_LE(error.true_mm, error.same_parameters_mm * (1.0 + 1e-12) + 1e-12) << n;
                largest_mm = std::max(largest_mm, error.same_parameters_mm);
                largest_true_mm = std::max(largest_true_mm, error.true_mm);
            }
            // The bound is not idle: the worst patch comes near it.
            EXPECT_GT(largest_mm, 0.25 * chord_error_mm);
            RecordProperty("largest_true_over_allowed_" + std::to_string(patches.size()) + "_" + std::to_string(chord_error_mm),
                           std::to_string(largest_true_mm / chord_error_mm));
        }
}

TEST(BezierTessellation, HasNoCracksAndFacesOutward) {
    for (const double chord_error_mm : {1.0, 0.1, 0.013}) {
        const TriangleMesh gem = tessellate(bezier_cabochon(gem_mm, gem_girdle_mm), chord_error_mm);
        EXPECT_TRUE(is_watertight(gem));
        EXPECT_GT(enclosed_volume_mm3(gem), 0.0);
        const std::vector<BezierPatch> teapot = bezier_teapot(20.0);
        for (int part = 0; part < teapot_parts; ++part) {
            const TriangleMesh mesh = tessellate(part_of(teapot, part), chord_error_mm);
            EXPECT_TRUE(is_watertight(mesh)) << part;
            EXPECT_GT(enclosed_volume_mm3(mesh), 0.0) << part;
        }
    }
}

TEST(BezierTessellation, CabochonsVolumeConverges) {
    // Two half ellipsoids; the cubics add at most three times their radial error.
    const double exact_mm3 = 2.0 / 3.0 * 3.14159265358979 * 6.0 * 4.5 * 4.5;
    const double volume_mm3 = enclosed_volume_mm3(tessellate(bezier_cabochon(gem_mm, gem_girdle_mm), 1.0e-4));
    EXPECT_GT(volume_mm3, exact_mm3 * (1.0 - 1.0e-4));
    EXPECT_LT(volume_mm3, exact_mm3 * (1.0 + 3.0 * 2.73e-4));
}

TEST(BezierTessellation, TooManyTrianglesAreRefused) {
    const auto message = testing_tools::input_error_of([] { tessellate(bezier_teapot(20.0), 1.0e-9); });
    EXPECT_NE(message.find("shape.chord_error_mm 1e-09: would take"), std::string::npos) << message;
}

TEST(BezierTeapot, FitsItsCubeExactly) {
    const std::vector<BezierPatch> patches = bezier_teapot(20.0);
    EXPECT_EQ(patches.size(), 40u);
    const openvdb::BBoxd bounds = bezier_bounds_mm(patches);
    EXPECT_NEAR(bounds.extents().x(), 20.0, 1e-9);
    EXPECT_LT(bounds.extents().y(), 20.0);
    EXPECT_LT(bounds.extents().z(), 20.0);
    EXPECT_NEAR(bounds.min().z(), 0.0, 1e-9);
    EXPECT_NEAR(bounds.getCenter().x(), 0.0, 1e-9);
    EXPECT_NEAR(bounds.getCenter().y(), 0.0, 1e-9);
    // No place of a patch is outside the bounds, and some come near.
    Vec3d low(1e9), high(-1e9);
    for (const BezierPatch& patch : patches)
        for (int i = 0; i <= 100; ++i)
            for (int j = 0; j <= 100; ++j) {
                const Vec3d p = position(patch, i / 100.0, j / 100.0);
                low = openvdb::math::minComponent(low, p);
                high = openvdb::math::maxComponent(high, p);
            }
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(low[axis], bounds.min()[axis] - 1e-9);
        EXPECT_LE(high[axis], bounds.max()[axis] + 1e-9);
        EXPECT_NEAR(low[axis], bounds.min()[axis], 1e-2);
        EXPECT_NEAR(high[axis], bounds.max()[axis], 1e-2);
    }
}

std::unique_ptr<Shape> teapot_shape(double chord_error_mm) {
    ShapeRecipe recipe;
    recipe.kind = ShapeKind::bezier;
    recipe.patches = BezierPatches::teapot;
    recipe.chord_error_mm = chord_error_mm;
    return make_shape(recipe);
}

TEST(BezierTeapot, IsTheUnionOfItsClosedParts) {
    const double chord_error_mm = 0.1;
    const auto shape = teapot_shape(chord_error_mm);
    const std::vector<BezierPatch> patches = bezier_teapot(20.0);
    std::vector<std::unique_ptr<Shape>> parts;
    for (int part = 0; part < teapot_parts; ++part)
        parts.push_back(make_solid_shape(solid_from_triangles(tessellate(part_of(patches, part), chord_error_mm), "part")));
    openvdb::BBoxd box = shape->bounds_mm();
    box.expand(0.5);
    std::size_t inside = 0;
    for (std::uint64_t n = 0; n < 20000; ++n) {
        const Vec3d p = random_point(box, 4, n);
        const bool in_a_part = std::any_of(parts.begin(), parts.end(), [&](const auto& part) { return part->contains(p); });
        ASSERT_EQ(shape->contains(p), in_a_part) << p;
        inside += in_a_part ? 1 : 0;
        if (n % 10 == 0 && !in_a_part) {
            double nearest = 1e9;
            for (const auto& part : parts) nearest = std::min(nearest, part->signed_distance_mm(p));
            ASSERT_NEAR(shape->signed_distance_mm(p), nearest, 1e-9) << p;
        }
    }
    EXPECT_GT(inside, 2000u);
    ASSERT_EQ(shape->bezier_patches().size(), 40u);
}

TEST(BezierTeapot, IsSolidWhereATeapotIsAndOpenInsideItsHandle) {
    const auto shape = teapot_shape(0.1);
    const openvdb::BBoxd bounds = shape->bounds_mm();
    // Newell's units, z up, as he gave them: x from -3 (handle) to 3.4 (spout).
    const double scale = bounds.extents().z() / 3.15;
    const auto at = [&](double x, double y, double z) {
        const double left = bounds.min().x() / scale;
        return Vec3d(x - -2.9916, y, z) * scale + Vec3d(left * scale, 0.0, 0.0);
    };
    for (const Vec3d& inside : {at(0, 0, 1), at(0, 0, 2.41), at(0, 0, 3.1), at(-2.83, 0, 1.8), at(2.35, 0, 1.5), at(0, 1.9, 1)})
        EXPECT_TRUE(shape->contains(inside)) << inside;
    // Inside the handle's loop, beside the knob, above the gap between lid and rim, in the spout's opening, below.
    for (const Vec3d& outside : {at(-2.3, 0, 1.5), at(0.5, 0, 2.9), at(1.35, 0, 2.43), at(3.0, 0, 2.45), at(0, 0, -0.01)})
        EXPECT_FALSE(shape->contains(outside)) << outside;
}

TEST(BezierTeapot, HandleEndsInsideTheBody) {
    const std::vector<BezierPatch> patches = bezier_teapot(20.0);
    const double chord_error_mm = 4.0e-3;
    const auto body = make_solid_shape(solid_from_triangles(tessellate(part_of(patches, 0), chord_error_mm), "body"));
    // The caps: handle above, handle below, spout below; no place of them is farther outside than the tessellation is off.
    for (const std::size_t cap : {36u, 37u, 38u})
        for (int i = 0; i <= 40; ++i)
            for (int j = 0; j <= 40; ++j)
                EXPECT_LT(body->signed_distance_mm(position(patches[cap], i / 40.0, j / 40.0)), chord_error_mm) << cap;
    // The spout's opening is outside.
    EXPECT_GT(body->signed_distance_mm(position(patches[39], 0.5, 0.5)), 1.0);
}

TEST(BezierShapes, BuildIntoAnOpalThatKeepsItsPatches) {
    const std::string recipe = R"(
[shape]
kind = "bezier"
patches = "cabochon"
size_mm = [6.0, 5.0, 3.0]
[grains]
num_sites = 100
voxel_size_mm = 0.1
)";
    const BuiltOpal built = build_opal(parse_recipe(recipe, "bezier.toml", {}), [](const std::string&) {});
    EXPECT_EQ(built.asset.bezier_patches.size(), 8u);
    const double volume_mm3 = 2.0 / 3.0 * 3.14159265358979 * 3.0 * 2.5 * 3.0;
    EXPECT_NEAR(double(built.asset.grain_id->activeVoxelCount()) * 1.0e-3, volume_mm3, 0.02 * volume_mm3);
}

}  // namespace
}  // namespace opal
