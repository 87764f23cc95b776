// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "../formats/expect_error.h"
#include "formats/image.h"
#include "renderer/host/environment_map.h"
#include "renderer/host/spectrum_tables.h"
#include "small_opal.h"

namespace opal {
namespace {

/// Linear sRGB that the observer sees in a direction: the environment's spectrum times D65.
Rgb3d rgb_towards(const EnvironmentMap& map, Vec3 direction) {
    const SpectrumTablesData tables = make_spectrum_tables();
    const EnvironmentFootprint footprint = environment_footprint(map.view(), direction);
    std::array<double, colorimetric_samples> spectrum;
    for (std::size_t i = 0; i < spectrum.size(); ++i)
        spectrum[i] = double(tables.white[i]) * double(environment_color(tables.view(), footprint, 360.0f + float(i)));
    return linear_srgb_from_xyz(xyz_of(spectrum));
}

TEST(Environment, ConstantDirectionsAreUniform) {
    EnvironmentDescription description;
    description.kind = EnvironmentKind::constant;
    const EnvironmentMap map = make_environment(description);
    // Within a texel the density per solid angle follows 1 / sin(theta): up to 1 % around the mean at this resolution.
    for (const Vec3 d : {Vec3{1, 0, 0}, Vec3{0, 0.6f, 0.8f}, Vec3{0.6f, 0, -0.8f}})
        EXPECT_NEAR(environment_pdf(map.view(), d), 1.0f / (4.0f * pi_f), 1e-2f / (4.0f * pi_f));
}

TEST(Environment, TheTentIsBroadAndBrightestTowardsItsLamp) {
    EnvironmentDescription description;
    description.kind = EnvironmentKind::tent;
    const EnvironmentMap tent = make_environment(description), studio = make_environment(EnvironmentDescription{});
    const Vec3 lamp = normalize({-0.557f, 0.321f, 0.766f});
    EXPECT_NEAR(rgb_towards(tent, lamp).g, 0.08 + 0.15 * 1.766 + 2.4, 0.01);
    EXPECT_NEAR(rgb_towards(tent, -1.0f * lamp).g, 0.08 + 0.15 * 0.234, 0.002);
    EXPECT_NEAR(rgb_towards(tent, {0, 0, -1}).g, 0.08, 0.002);
    // What makes opals noisy: the mean of the squared radiance over the squared mean, over all directions.
    const auto contrast = [](Rgb (*radiance)(Vec3)) {
        double sum = 0.0, squares = 0.0;
        constexpr int count = 100'000;
        for (int k = 0; k < count; ++k) {
            const RandomBlock block = random_block(1, RandomStream::bench, std::uint64_t(k), 0);
            const float z = 2.0f * uniform_float(block.value[0]) - 1.0f, turn = 2.0f * pi_f * uniform_float(block.value[1]);
            const double value =
                double(radiance({std::sqrt(1.0f - z * z) * std::cos(turn), std::sqrt(1.0f - z * z) * std::sin(turn), z}).g);
            sum += value / count;
            squares += value * value / count;
        }
        return squares / (sum * sum);
    };
    EXPECT_GT(contrast(studio_radiance), 15.0 * contrast(tent_radiance));
    EXPECT_NEAR(double(tent.mean_luminance), 0.08 + 0.15 + 2.4 * 0.1, 0.005);  // of cosine^4 over the sphere: 1 / 10
}

TEST(Environment, RotationTurnsTheLightAboutZ) {
    EnvironmentDescription description;
    const EnvironmentMap plain = make_environment(description);
    description.rotate_deg = 90.0;
    const EnvironmentMap turned = make_environment(description);
    const Vec3 key = normalize({-0.6f, 0.3f, 0.74f});
    const Vec3 turned_key{-key.y, key.x, key.z};
    EXPECT_NEAR(rgb_towards(turned, turned_key).g, rgb_towards(plain, key).g, 1e-3);
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
    // The colours come back as well as the upsampling's table has them.
    EXPECT_NEAR(rgb_towards(map, {0, 1, 0}).r, 4.0, 0.02);
    EXPECT_NEAR(rgb_towards(map, {1, 0, 0}).b, 4.0, 0.02);
    EXPECT_NEAR(rgb_towards(map, {-1, 0, 0}).b, 0.25, 1e-5);

    image.pixel(2, 1)[1] = -1.0f;
    write_exr(folder / "negative.exr", image);
    description.file = folder / "negative.exr";
    EXPECT_INPUT_ERROR(make_environment(description), "the lowest, -1, at texel (2, 1); together");
    image.pixel(2, 1)[1] = std::nanf("");
    write_exr(folder / "nan.exr", image);
    description.file = folder / "nan.exr";
    EXPECT_INPUT_ERROR(make_environment(description), "texel (2, 1) is nan");
    description.file = folder / "missing.exr";
    EXPECT_INPUT_ERROR(make_environment(description), "no such image file");
}

/// As a filter with negative lobes leaves them beside a bright edge.
TEST(Environment, SlightlyNegativeTexelsCountAsNone) {
    const ScratchFolder folder;
    Image image;
    image.width = 4;
    image.height = 2;
    image.channel_names = {"R", "G", "B"};
    image.pixels.assign(24, 1.0f);
    image.pixel(1, 0)[0] = 0.0f;
    write_exr(folder / "clean.exr", image);
    image.pixel(1, 0)[0] = -0.05f;
    write_exr(folder / "ringing.exr", image);
    EnvironmentDescription description;
    description.kind = EnvironmentKind::file;
    std::vector<std::string> notices;
    description.file = folder / "clean.exr";
    const EnvironmentMap clean = make_environment(description, Upsampling::jakob_hanika, &notices);
    EXPECT_TRUE(notices.empty());
    description.file = folder / "ringing.exr";
    const EnvironmentMap ringing = make_environment(description, Upsampling::jakob_hanika, &notices);
    ASSERT_EQ(notices.size(), 1u);
    EXPECT_NE(notices[0].find("1 values of texels are negative, the lowest, -0.05, at texel (1, 0)"), std::string::npos);
    EXPECT_EQ(ringing.mean_luminance, clean.mean_luminance);
    EXPECT_EQ(ringing.column_cdf, clean.column_cdf);
    // 0.3 of 23 is more than a hundredth.
    image.pixel(1, 0)[0] = -0.3f;
    write_exr(folder / "negative.exr", image);
    description.file = folder / "negative.exr";
    EXPECT_INPUT_ERROR(make_environment(description), "allowed: 0.01");
}

}  // namespace
}  // namespace opal
