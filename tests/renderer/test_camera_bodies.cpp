// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "on_backends.h"
#include "small_opal.h"

/// Cameras whose rays start partly inside a body, against closed forms.
namespace opal {
namespace {

class CameraBodies : public OnBackends {};

constexpr int size_px = 32;

std::string scene(const std::string& camera, const std::string& material) {
    return "[render]\nwidth = 32\nheight = 32\nsampler = \"independent\"\nfilter = \"box\"\n[camera]\n" + camera +
           "[environment]\nkind = \"constant\"\n[[material]]\nname = \"m\"\nkind = \"dielectric\"\n" + material +
           "[[object]]\nkind = \"sphere\"\nradius_mm = 3\nmaterial = \"m\"\n";
}

std::string window(const std::string& position, const std::string& target) {
    return "kind = \"orthographic\"\nview_height_mm = 8\nposition_mm = " + position + "\ntarget_mm = " + target + "\n";
}

void expect_invisible(const char* backend, const std::string& text) {
    const Rendered rendered = render_text(text, 60, backend);
    EXPECT_EQ(rendered.outcome.counters.lost_paths, 0u) << text;
    for (const char* channel : {"R", "G", "B"}) {
        const MeanEstimate mean = region_mean(rendered.image, channel, 0, 0, size_px, size_px);
        const double truncated = rendered.outcome.totals.truncated_rgb[1] / double(rendered.outcome.totals.samples);
        EXPECT_NEAR(mean.mean + truncated, 1.0, 4.0 * mean.standard_error + 1.0e-4) << channel << text;
        EXPECT_LT(mean.standard_error, 0.005);
    }
}

/// Windows that cut a cap off a glass ball, from inside and from outside of the ball at their middles, and lenses: uniform light
/// stays uniform.
TEST_P(CameraBodies, GlassCutByTheCameraIsInvisible) {
    const std::string glass = "n = 1.5\n";
    expect_invisible(GetParam(), scene(window("[0, 2.5, 0]", "[0, 9, 0]"), glass));
    expect_invisible(GetParam(), scene(window("[0, -2.5, 0]", "[0, 9, 0]"), glass));
    expect_invisible(GetParam(), scene(window("[3.5, 2.5, 0]", "[3.5, 9, 0]"), glass));
    const std::string lens = "aperture_radius_mm = 2.5\nfocus_mm = 20\nvertical_fov_deg = 10\n";
    expect_invisible(GetParam(), scene(lens + "position_mm = [0, 2.6, 0]\ntarget_mm = [0, 9, 0]\n", glass));
    expect_invisible(GetParam(), scene(lens + "position_mm = [2, 2.6, 0]\ntarget_mm = [2, -9, 0]\n", glass));
}

/// An absorbing ball that does not refract, cut by the window a millimetre before its middle: exp(-a L), L the way that is left.
TEST_P(CameraBodies, WhatIsBeforeTheWindowDoesNotAbsorb) {
    for (const double centre_mm : {0.0, 2.9}) {
        const std::string x = std::to_string(centre_mm);
        const Rendered rendered =
            render_text(scene(window("[" + x + ", -1, 0]", "[" + x + ", 9, 0]"), "n = 1.0\nmedium = { sigma_a_per_mm = 0.4 }\n"),
                        400, GetParam());
        double expected = 0.0;
        constexpr int points = 2000;
        for (int i = 0; i < points; ++i)
            for (int j = 0; j < points; ++j) {
                const double a = 8.0 * ((i + 0.5) / points - 0.5) + centre_mm, b = 8.0 * ((j + 0.5) / points - 0.5);
                const double half = std::sqrt(std::max(0.0, 9.0 - a * a - b * b));
                expected += std::exp(-0.4 * (half + std::min(half, 1.0))) / (double(points) * points);
            }
        const MeanEstimate mean = region_mean(rendered.image, "G", 0, 0, size_px, size_px);
        EXPECT_NEAR(mean.mean, expected, 4.0 * mean.standard_error + 1.0e-3);  // of the ball's triangles
        EXPECT_LT(mean.standard_error, 0.002);
        EXPECT_EQ(rendered.outcome.counters.lost_paths, 0u);
    }
}

/// Rays ask for themselves only where they differ.
TEST(BodiesAtTheCamera, AreKnownBeforehandWhereTheyAreTheSame) {
    const auto view_of = [](const std::string& camera) {
        const SceneDescription description = parse_scene(scene(camera, "n = 1.5\n"), "test.toml", {});
        std::vector<std::string> notices;
        const HostScene host(description, notices);
        return std::pair(host.view().cut_bodies.inside, host.view().camera_bodies.inside);
    };
    using Known = std::pair<std::uint64_t, std::uint64_t>;
    EXPECT_EQ(view_of(window("[0, 2.5, 0]", "[0, 9, 0]")), Known(1, 0));
    EXPECT_EQ(view_of(window("[0, -3.1, 0]", "[0, 9, 0]")), Known(0, 0));
    EXPECT_EQ(view_of("kind = \"orthographic\"\nview_height_mm = 2\nposition_mm = [0, 1, 0]\ntarget_mm = [0, 9, 0]\n"),
              Known(0, 1));
    EXPECT_EQ(view_of("kind = \"perspective\"\nposition_mm = [0, 1, 0]\ntarget_mm = [0, 9, 0]\n"), Known(0, 1));
    EXPECT_EQ(view_of("aperture_radius_mm = 0.5\nposition_mm = [0, -3.2, 0]\ntarget_mm = [0, 9, 0]\n"), Known(0, 0));
    EXPECT_EQ(view_of("aperture_radius_mm = 0.5\nposition_mm = [0, -2.99, 0]\ntarget_mm = [0, 9, 0]\n"), Known(1, 0));
}

INSTANTIATE_TEST_SUITE_P(, CameraBodies, cpu_and_cuda(), backend_name);

}  // namespace
}  // namespace opal
