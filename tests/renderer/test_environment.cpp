// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "../formats/expect_error.h"
#include "formats/image.h"
#include "renderer/host/environment_map.h"
#include "small_opal.h"

namespace opal {
namespace {

TEST(Environment, ConstantDirectionsAreUniform) {
    EnvironmentDescription description;
    description.kind = EnvironmentKind::constant;
    const EnvironmentMap map = make_environment(description);
    // Within a texel the density per solid angle follows 1 / sin(theta): up to 1 % around the mean at this resolution.
    for (const Vec3 d : {Vec3{1, 0, 0}, Vec3{0, 0.6f, 0.8f}, Vec3{0.6f, 0, -0.8f}})
        EXPECT_NEAR(environment_pdf(map.view(), d), 1.0f / (4.0f * pi_f), 1e-2f / (4.0f * pi_f));
}

TEST(Environment, RotationTurnsTheLightAboutZ) {
    EnvironmentDescription description;
    const EnvironmentMap plain = make_environment(description);
    description.rotate_deg = 90.0;
    const EnvironmentMap turned = make_environment(description);
    const Vec3 key = normalize({-0.6f, 0.3f, 0.74f});
    const Vec3 turned_key{-key.y, key.x, key.z};
    EXPECT_NEAR(environment_radiance(turned.view(), turned_key).g, environment_radiance(plain.view(), key).g, 1e-3f);
}

TEST(Environment, FilesAreOrientedAndChecked) {
    const ScratchFolder folder;
    Image image;
    image.width = 8;
    image.height = 4;
    image.channel_names = {"R", "G", "B"};
    image.pixels.assign(8 * 4 * 3, 0.25f);
    // The middle of the picture is ahead (+Y), its right quarter is to the right (+X).
    for (const int x : {3, 4})
        for (const int y : {1, 2}) image.pixel(x, y)[0] = 4.0f;
    for (const int x : {5, 6})
        for (const int y : {1, 2}) image.pixel(x, y)[2] = 4.0f;
    write_exr(folder / "map.exr", image);
    EnvironmentDescription description;
    description.kind = EnvironmentKind::file;
    description.file = folder / "map.exr";
    const EnvironmentMap map = make_environment(description);
    EXPECT_NEAR(environment_radiance(map.view(), {0, 1, 0}).r, 4.0f, 1e-5f);
    EXPECT_NEAR(environment_radiance(map.view(), {1, 0, 0}).b, 4.0f, 1e-5f);
    EXPECT_NEAR(environment_radiance(map.view(), {-1, 0, 0}).b, 0.25f, 1e-5f);

    image.pixel(2, 1)[1] = -1.0f;
    write_exr(folder / "negative.exr", image);
    description.file = folder / "negative.exr";
    EXPECT_INPUT_ERROR(make_environment(description), "texel (2, 1) is -1");
    description.file = folder / "missing.exr";
    EXPECT_INPUT_ERROR(make_environment(description), "no such image file");
}

}  // namespace
}  // namespace opal
