// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "chi_square.h"
#include "renderer/core/camera.h"
#include "renderer/core/phase.h"
#include "renderer/core/surface_scattering.h"

namespace opal {
namespace {

TEST(Samplers, RayleighCosine) {
    EXPECT_TRUE(density_matches([](double u) { return double(sample_rayleigh_cosine(float(u))); },
                                [](double c) { return 2.0 * double(pi_f) * double(rayleigh_phase(float(c))); }, -1.0, 1.0));
}

TEST(Samplers, HenyeyGreensteinCosine) {
    for (const float g : {-0.6f, 0.0f, 0.3f, 0.8f, 0.95f})
        EXPECT_TRUE(density_matches([g](double u) { return double(sample_henyey_greenstein_cosine(float(u), g)); },
                                    [g](double c) { return 2.0 * double(pi_f) * double(henyey_greenstein_phase(float(c), g)); },
                                    -1.0, 1.0))
            << "g = " << g;
}

TEST(Samplers, MeanCosineOfHenyeyGreensteinIsG) {
    const int n = 200000;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) sum += double(sample_henyey_greenstein_cosine((float(i) + 0.5f) / float(n), 0.7f));
    EXPECT_NEAR(sum / n, 0.7, 1e-4);
}

TEST(Samplers, DeflectKeepsTheCosine) {
    const Vec3 direction = normalize({0.3f, -0.5f, 0.8f});
    for (const float cosine : {-1.0f, -0.4f, 0.0f, 0.9f, 1.0f})
        for (const float u : {0.0f, 0.37f, 0.8f}) EXPECT_NEAR(dot(direction, deflect(direction, cosine, u)), cosine, 2e-6f);
}

TEST(Samplers, CosineHemisphere) {
    const Vec3 normal = normalize({-0.2f, 0.9f, 0.1f});
    EXPECT_TRUE(density_matches([&](double u) { return double(dot(sample_cosine(normal, float(u), 0.3f), normal)); },
                                [](double c) { return 2.0 * c; }, 0.0, 1.0));
}

TEST(Samplers, TentFilter) {
    EXPECT_TRUE(density_matches([](double u) { return double(sample_tent(float(u))); },
                                [](double x) { return 1.0 - std::abs(x); }, -1.0, 1.0));
}

}  // namespace
}  // namespace opal
