// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "chi_square.h"
#include "formats/units.h"
#include "renderer/core/camera.h"
#include "renderer/core/medium_flight.h"
#include "renderer/core/pixel_filter.h"
#include "renderer/core/surface_scattering.h"
#include "renderer/host/environment_map.h"

/// The samplers of the renderer that are no phase functions (test_phase.cpp) against their densities.
namespace opal {
namespace {

TEST(Samplers, CosineHemisphere) {
    for (const Vec3 normal : {normalize({-0.2f, 0.9f, 0.1f}), Vec3{0.0f, 0.0f, -1.0f}}) {
        const Frame frame(normal);
        EXPECT_TRUE(check_sampler(
            "cosine hemisphere", SamplerDomain<2>{{0.0, -units::pi}, {1.0, units::pi}, {32, 32}},
            [&](SamplerRandom& random) {
                const float u1 = random.next();
                const Vec3 direction = sample_cosine(normal, u1, random.next());
                return SamplerPoint<2>{
                    std::min(1.0, double(dot(direction, normal))),
                    std::atan2(double(dot(direction, frame.bitangent)), double(dot(direction, frame.tangent)))};
            },
            [](SamplerPoint<2> p) { return p[0] / units::pi; }));
    }
}

TEST(Samplers, PixelFilters) {
    const std::pair<const char*, PixelFilter> filters[] = {{"tent", {PixelFilterKind::tent, 1.0f}},
                                                           {"wide tent", {PixelFilterKind::tent, 1.75f}},
                                                           {"box", {PixelFilterKind::box, 0.5f}},
                                                           {"gaussian", {PixelFilterKind::gaussian, 1.5f}},
                                                           {"blackman-harris", {PixelFilterKind::blackman_harris, 2.0f}}};
    for (const auto& [name, filter] : filters) {
        const double radius = double(filter.radius_px);
        EXPECT_TRUE(check_inversion(
            name, -radius, radius, [&](float u) { return sample_pixel_filter(filter, u); },
            [&](double x) { return double(pixel_filter_density(filter, float(x))); }));
    }
}

/// Against the filters' own formulas: a tent of radius one, a Gaussian cut at three standard deviations, Harris's window.
TEST(PixelFilter, DensitiesAreTheFilters) {
    EXPECT_FLOAT_EQ(pixel_filter_density({PixelFilterKind::tent, 1.0f}, -0.25f), 0.75f);
    EXPECT_EQ(pixel_filter_density({PixelFilterKind::box, 0.5f}, 0.49f), 1.0f);
    EXPECT_EQ(pixel_filter_density({PixelFilterKind::box, 0.5f}, 0.51f), 0.0f);
    const PixelFilter gaussian{PixelFilterKind::gaussian, 1.5f};
    EXPECT_NEAR(pixel_filter_density(gaussian, 0.7f) / pixel_filter_density(gaussian, 0.0f), std::exp(-0.5 * 1.96), 1.0e-6);
    const PixelFilter window{PixelFilterKind::blackman_harris, 2.0f};
    EXPECT_NEAR(pixel_filter_density(window, 1.0f) / pixel_filter_density(window, 0.0f), 0.35875 - 0.14128, 1.0e-6);
    EXPECT_NEAR(pixel_filter_density(window, 2.0f) / pixel_filter_density(window, 0.0f), 6.0e-5, 1.0e-6);
}

/// Strata of numbers stay strata of places.
TEST(PixelFilter, SamplingIsMonotone) {
    for (const PixelFilterKind kind : {PixelFilterKind::gaussian, PixelFilterKind::blackman_harris, PixelFilterKind::tent}) {
        float last = -2.0f;
        for (int i = 0; i < 4096; ++i) {
            const float x = sample_pixel_filter({kind, 2.0f}, float(i) / 4096.0f);
            EXPECT_GE(x, last - 4.0e-6f) << i;
            last = x;
        }
        EXPECT_LE(last, 2.0f);
    }
}

TEST(Samplers, LensDisc) {
    Camera camera;
    camera.forward = {0.0f, 1.0f, 0.0f};
    camera.right = {0.5f, 0.0f, 0.0f};
    camera.down = {0.0f, 0.0f, -0.5f};
    camera.aperture_radius_mm = 2.0f;
    camera.focus_mm = 100.0f;
    EXPECT_TRUE(check_sampler(
        "lens", SamplerDomain<2>{{-2.001, -2.001}, {2.001, 2.001}, {32, 32}},
        [&](SamplerRandom& random) {
            const float u = random.next();
            const Vec3 origin = camera_ray(camera, 0.3f, 0.8f, u, random.next()).origin;
            return SamplerPoint<2>{double(origin.x), double(origin.z)};
        },
        [](SamplerPoint<2> p) { return std::hypot(p[0], p[1]) < 2.0 ? 1.0 / (4.0 * units::pi) : 0.0; }));
}

TEST(Samplers, FlightThroughAMedium) {
    for (const float sigma_s_per_mm : {1.0e-3f, 0.7f, 500.0f}) {
        OpalView opal;
        LaneMedium<1> medium;
        medium.sigma_mie.v[0] = sigma_s_per_mm;
        // The largest float below 1 gives 16.7 mean free paths.
        const double farthest_mm = 17.0 / double(sigma_s_per_mm);
        std::uint32_t path = 0;
        EXPECT_TRUE(check_sampler(
            "flight", SamplerDomain<1>{{0.0}, {farthest_mm}, {64}},
            [&](SamplerRandom&) {
                PathRandom random(1, 0, path++);
                LaneWeights<1> weights;
                std::uint64_t violations = 0;
                MediumFlight<1> flight(opal, medium, {}, weights, random, violations);
                return SamplerPoint<1>{double(flight.advance(3.0e38f, weights))};
            },
            [&](SamplerPoint<1> t) { return double(sigma_s_per_mm) * std::exp(-double(sigma_s_per_mm) * t[0]); }));
    }
}

/// Over the sine of the elevation and the azimuth, in which equal cells are equal solid angles.
::testing::AssertionResult check_environment(const std::string& name, const EnvironmentDescription& description) {
    const EnvironmentMap map = make_environment(description);
    return check_sampler(
        name, SamplerDomain<2>{{-1.0, -units::pi}, {1.0, units::pi}, {24, 48}},
        [&](SamplerRandom& random) {
            const float u1 = random.next();
            const Vec3 d = sample_environment(map.view(), u1, random.next());
            return SamplerPoint<2>{double(d.z), std::atan2(double(d.y), double(d.x))};
        },
        [&](SamplerPoint<2> p) {
            const double sine = std::sqrt(1.0 - p[0] * p[0]);
            return double(environment_pdf(map.view(), {float(sine * std::cos(p[1])), float(sine * std::sin(p[1])), float(p[0])}));
        });
}

TEST(Samplers, Environment) {
    EnvironmentDescription description;
    EXPECT_TRUE(check_environment("studio", description));
    description.rotate_deg = 75.0;
    EXPECT_TRUE(check_environment("studio, turned", description));
    description.kind = EnvironmentKind::constant;
    EXPECT_TRUE(check_environment("constant environment", description));
}

}  // namespace
}  // namespace opal
