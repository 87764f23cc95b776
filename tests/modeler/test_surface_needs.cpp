// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/surface_needs.h"

#include <gtest/gtest.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "modeler/box_shape.h"
#include "modeler/cabochon_shape.h"
#include "modeler/ellipsoid_shape.h"

namespace opal {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

SurfaceNeeds needs_of(const Shape& shape, double accepted_mm, double finest_mm = 1.0e-4, double coarsest_mm = 1.0) {
    return coarsest_surface_voxels(
        shape, [=](const openvdb::Vec3d&) { return accepted_mm; }, finest_mm, coarsest_mm);
}

/// Farthest that corners and middles of a level set's faces lie from the shape.
double farthest_face_mm(const Shape& shape, double voxel_mm) {
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(*shape.level_set(voxel_mm), points, triangles, quads);
    double farthest_mm = 0.0;
    const auto look_at = [&](const openvdb::Vec3d& point_mm) {
        farthest_mm = std::max(farthest_mm, std::abs(shape.signed_distance_mm(point_mm)));
    };
    for (const openvdb::Vec3s& point : points) look_at(point);
    // Halves of a four-sided face meet along its diagonal.
    for (const openvdb::Vec4I& quad : quads) look_at(0.5 * (openvdb::Vec3d(points[quad[0]]) + openvdb::Vec3d(points[quad[2]])));
    return farthest_mm;
}

TEST(SurfaceNeeds, ASpheresVoxelsGrowWithTheRootOfItsRadius) {
    for (const double accepted_mm : {0.001, 0.01}) {
        const EllipsoidShape sphere(openvdb::Vec3d(10.0));
        const SurfaceNeeds needs = needs_of(sphere, accepted_mm);
        const double expected_mm = std::sqrt(2.0 * 5.0 * accepted_mm);  // h^2 / 2r
        EXPECT_LE(needs.voxel_size_mm, 1.001 * expected_mm);
        EXPECT_GE(needs.voxel_size_mm, expected_mm / 1.2);
        EXPECT_LE(needs.error_mm, accepted_mm);
        EXPECT_NEAR(needs.error_mm, needs.voxel_size_mm * needs.voxel_size_mm / 10.0, 0.02 * needs.error_mm);
        EXPECT_EQ(needs.error_over_accepted, needs.error_mm / accepted_mm);
    }
}

TEST(SurfaceNeeds, TheLevelSetIsAsGoodAsSaid) {
    const EllipsoidShape ellipsoid(openvdb::Vec3d(12.0, 8.0, 3.0));
    const CabochonShape cabochon({12.0, 9.0, 4.5}, 0.8);
    for (const Shape* shape : {static_cast<const Shape*>(&ellipsoid), static_cast<const Shape*>(&cabochon)}) {
        for (const double accepted_mm : {0.003, 0.01, 0.03}) {
            const SurfaceNeeds needs = needs_of(*shape, accepted_mm);
            const double farthest_mm = farthest_face_mm(*shape, needs.voxel_size_mm);
            EXPECT_LE(farthest_mm, accepted_mm) << needs.voxel_size_mm;
            // Voxels of twice the size would not do, so these are not needlessly fine.
            EXPECT_GT(farthest_face_mm(*shape, 2.0 * needs.voxel_size_mm), 0.5 * accepted_mm) << needs.voxel_size_mm;
        }
    }
}

TEST(SurfaceNeeds, EdgesTakeTheFinestAndFlatFacesTheCoarsest) {
    const BoxShape box({8.0, 6.0, 4.0});
    EXPECT_EQ(needs_of(box, 0.001, 0.01, 0.2).voxel_size_mm, 0.01);
    EXPECT_GT(needs_of(box, 0.001, 0.01, 0.2).error_over_accepted, 1.0);
    // The middle of the top alone.
    const auto top = [](const openvdb::Vec3d& p) { return p.z() > 3.99 && std::hypot(p.x(), p.y()) < 2.0 ? 0.001 : infinity; };
    const SurfaceNeeds flat = coarsest_surface_voxels(box, top, 0.01, 0.2);
    EXPECT_EQ(flat.voxel_size_mm, 0.2);
    EXPECT_LT(flat.error_mm, 1.0e-6);
    EXPECT_GT(flat.places, 100u);
}

TEST(SurfaceNeeds, ThinWallsTakeVoxelsThatSeeBothSides) {
    const BoxShape plate({8.0, 8.0, 0.3});
    const auto middle = [](const openvdb::Vec3d& p) { return std::hypot(p.x(), p.y()) < 2.0 ? 0.001 : infinity; };
    // 1.5 voxels in from one face must not be nearer to the other: half the thickness at most.
    EXPECT_LE(coarsest_surface_voxels(plate, middle, 0.01, 0.2).voxel_size_mm, 0.151 / 1.5);
    EXPECT_GE(coarsest_surface_voxels(plate, middle, 0.01, 0.2).voxel_size_mm, 0.15 / 1.5 / 1.2);
}

TEST(SurfaceNeeds, NothingAskedNothingNeeded) {
    const SurfaceNeeds needs = needs_of(BoxShape({8.0, 6.0, 4.0}), infinity, 0.01, 0.2);
    EXPECT_EQ(needs.places, 0u);
    EXPECT_EQ(needs.voxel_size_mm, 0.2);
    EXPECT_EQ(needs.error_mm, 0.0);
}

}  // namespace
}  // namespace opal
