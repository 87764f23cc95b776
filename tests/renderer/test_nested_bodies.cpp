// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "renderer/core/nested_bodies.h"
#include "renderer/host/enclosure.h"
#include "renderer/host/field_grid.h"
#include "renderer/host/mesh_contact.h"
#include "small_opal.h"

namespace opal {
namespace {

TEST(NestedBodies, TheHighestIsThere) {
    NestedBodies place;
    EXPECT_EQ(place.current(), -1);
    place = place.entered(2).entered(63).entered(5);
    EXPECT_EQ(place.current(), 63);
    place = place.left(63);
    EXPECT_EQ(place.current(), 5);
    EXPECT_EQ(place.left(2).current(), 5);
    EXPECT_EQ(place.left(5).current(), 2);
    // Again entered, or left without having been entered: nothing happens.
    EXPECT_EQ(place.entered(5).inside, place.inside);
    EXPECT_EQ(place.left(7).inside, place.inside);
    EXPECT_EQ(place.left(5).left(2).current(), -1);
}

TEST(Enclosure, WindingNumberTellsInsideFromOutside) {
    const MeshData ball = make_sphere(2.0);
    EXPECT_TRUE(encloses(ball, {0.1f, -0.3f, 0.2f}));
    EXPECT_TRUE(encloses(ball, {0.0f, 1.98f, 0.0f}));
    EXPECT_FALSE(encloses(ball, {0.0f, 2.02f, 0.0f}));
    EXPECT_FALSE(encloses(ball, {50.0f, 2.0f, 1.0f}));
}

/// A ball of 3 mm in voxels of 0.1 mm, moved by 10 mm along x.
struct ReachFixture {
    OpalAsset asset = SmallOpal().make();
    FieldGridData grid{*asset.shape};
    OpalView body;

    ReachFixture() {
        body.shape = grid.view();
        body.world_from_object.origin = {10.0f, 0.0f, 0.0f};
    }
    bool reaches(MeshData mesh, Vec3 at) const {
        for (Vec3& position : mesh.positions) position = position + at;
        return reaches_inside(mesh, body);
    }
};

TEST(Enclosure, MeshesThatReachIntoABodyAreFound) {
    const ReachFixture fixture;
    EXPECT_TRUE(fixture.reaches(make_sphere(0.05), {10.0f, 0.5f, 0.3f})) << "far inside, smaller than a voxel";
    EXPECT_TRUE(fixture.reaches(make_plane(2000.0), {0.0f, 0.0f, -2.8f})) << "a large plane that cuts off a cap";
    EXPECT_TRUE(fixture.reaches(make_sphere(1.0), {10.0f, 3.8f, 0.0f})) << "0.2 mm deep";
    EXPECT_FALSE(fixture.reaches(make_plane(2000.0), {0.0f, 0.0f, -3.1f})) << "stands beneath";
    EXPECT_FALSE(fixture.reaches(make_sphere(1.0), {10.0f, 4.1f, 0.0f})) << "touches nearly";
    EXPECT_FALSE(fixture.reaches(make_sphere(1.0), {0.0f, 0.0f, 0.0f})) << "where the body would be without its transform";
    EXPECT_FALSE(fixture.reaches(make_sphere(9.0), {10.0f, 0.0f, 0.0f})) << "all around";
}

LightGeometry flat(LightShape shape, Vec3 position, Vec3 normal) {
    LightGeometry light;
    light.shape = shape;
    light.position = position;
    light.normal = normalize(normal);
    const Frame frame(light.normal);
    light.half_x = 2.0f * frame.tangent;
    light.half_y = 0.5f * frame.bitangent;
    light.radius_mm = 2.0f;
    return light;
}

/// Against a ball of 2 mm: closed forms of the distances. Its triangles lie inside it by 1e-3 of its radius at most.
TEST(MeshContact, LightsThatReachIntoABodyAreFound) {
    const MeshData ball = make_sphere(2.0);
    LightGeometry sphere;
    sphere.shape = LightShape::sphere;
    sphere.radius_mm = 1.0f;
    for (const bool touches : {true, false}) {
        const float apart = touches ? -0.01f : 0.01f;
        sphere.position = (3.0f + apart) * normalize(Vec3{1.0f, -2.0f, 0.5f});
        EXPECT_EQ(touches_light(ball, sphere), touches);
        for (const Vec3 toward : {Vec3{1.0f, 0.0f, 0.0f}, normalize(Vec3{0.3f, 0.8f, -0.6f})}) {
            // A disk that faces the ball, and one whose rim points at it.
            EXPECT_EQ(touches_light(ball, flat(LightShape::disk, (2.0f + apart) * toward, toward)), touches);
            const Vec3 across = Frame(toward).tangent;
            EXPECT_EQ(touches_light(ball, flat(LightShape::disk, (4.0f + apart) * toward, across)), touches);
            LightGeometry rectangle = flat(LightShape::rectangle, {}, across);
            const Vec3 longer = normalize(rectangle.half_x);
            rectangle.position = (4.0f + apart) * longer;
            EXPECT_EQ(touches_light(ball, rectangle), touches);
            // By its short side, and shifted along it so that a corner is nearest.
            rectangle.position = (2.5f + apart) * normalize(rectangle.half_y);
            EXPECT_EQ(touches_light(ball, rectangle), touches);
            rectangle.position =
                rectangle.half_x + rectangle.half_y + (2.0f + apart) * normalize(longer + normalize(rectangle.half_y));
            EXPECT_EQ(touches_light(ball, rectangle), touches);
        }
    }
    // Wholly inside: the surface is not touched.
    sphere.position = {};
    EXPECT_FALSE(touches_light(ball, sphere));
    EXPECT_TRUE(encloses(ball, sphere.position));
    // All around it.
    sphere.radius_mm = 9.0f;
    EXPECT_TRUE(touches_light(ball, sphere));
}

}  // namespace
}  // namespace opal
