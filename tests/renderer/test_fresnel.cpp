// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "renderer/core/surface_scattering.h"

namespace opal {
namespace {

TEST(Fresnel, NormalIncidenceAndTotalReflection) {
    float cos_transmitted;
    EXPECT_NEAR(fresnel_dielectric(1.0f, 1.5f, cos_transmitted), 0.04f, 1e-6f);
    EXPECT_NEAR(cos_transmitted, 1.0f, 1e-6f);
    EXPECT_EQ(fresnel_dielectric(0.5f, 1.0f / 1.5f, cos_transmitted), 1.0f);
    EXPECT_EQ(cos_transmitted, 0.0f);
}

/// At Brewster's angle p vanishes: the unpolarized reflectance is half of s, ((1 - n^2) / (1 + n^2))^2 / 2.
TEST(Fresnel, Brewster) {
    const float n = 1.42f;
    float cos_transmitted;
    const float cos_brewster = 1.0f / sqrtf(1.0f + n * n);
    EXPECT_NEAR(fresnel_dielectric(cos_brewster, n, cos_transmitted), 0.5f * square((1.0f - n * n) / (1.0f + n * n)), 1e-6f);
}

TEST(Fresnel, SnellsLaw) {
    const Vec3 direction = normalize({0.6f, 0.0f, -0.8f});
    float cos_transmitted;
    fresnel_dielectric(0.8f, 1.42f, cos_transmitted);
    const Vec3 refracted = refract(direction, {0.0f, 0.0f, 1.0f}, 1.42f, 0.8f, cos_transmitted);
    EXPECT_NEAR(refracted.x * 1.42f, 0.6f, 1e-6f);
    EXPECT_NEAR(length(refracted), 1.0f, 1e-6f);
}

TEST(Fresnel, InterpolatedNormalsNeverSendARayThroughTheWrongSide) {
    Surface surface;
    surface.geometric_normal = {0.0f, 0.0f, 1.0f};
    for (float tilt = -0.6f; tilt <= 0.6f; tilt += 0.05f) {
        surface.shading_normal = normalize({tilt, 0.2f * tilt, 1.0f});
        for (float angle = -1.55f; angle < 1.55f; angle += 0.05f)
            for (const float side : {-1.0f, 1.0f}) {
                const Vec3 direction{sinf(angle), 0.0f, side * cosf(angle)};
                const float opal[1] = {1.42f}, air[1] = {1.0f};
                const bool entering = side < 0.0f;
                const DielectricSplit<1> split =
                    split_dielectric<1>(direction, surface, entering ? air : opal, entering ? opal : air);
                EXPECT_NEAR(length(split.reflected), 1.0f, 1e-5f);
                EXPECT_LT(split.reflected.z * direction.z, 0.0f);
                EXPECT_GE(split.reflectance[0], 0.0f);
                if (split.reflectance[0] == 1.0f) continue;
                EXPECT_NEAR(length(split.refracted), 1.0f, 1e-5f);
                EXPECT_GT(split.refracted.z * direction.z, 0.0f);
            }
    }
}

}  // namespace
}  // namespace opal
