// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "../formats/expect_error.h"
#include "chi_square.h"
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

/// Directions drawn in cells of equal solid angle, compared with the density integrated over each cell by a fine grid.
void expect_directions_follow_density(const EnvironmentMap& map) {
    constexpr int rows = 12, columns = 24, draws = 400000, fine = 100;
    const EnvironmentView view = map.view();
    std::vector<double> observed(rows * columns, 0.0), expected(rows * columns, 0.0);
    const auto cell_of = [&](Vec3 d) {
        const int row = std::min(rows - 1, int(0.5f * (1.0f - d.z) * rows));
        const int column = std::min(columns - 1, int(wrap_unit(atan2f(d.y, d.x) * (0.5f / pi_f)) * columns));
        return std::size_t(row * columns + column);
    };
    for (int i = 0; i < draws; ++i) {
        const RandomBlock block = random_block(2, RandomStream::render_paths, std::uint64_t(i), 0);
        observed[cell_of(sample_environment(view, uniform_float(block.value[0]), uniform_float(block.value[1])))] += 1.0;
    }
    double total = 0.0;
    const double solid_angle = 4.0 * double(pi_f) / (rows * fine * columns * fine);
    for (int r = 0; r < rows * fine; ++r)
        for (int c = 0; c < columns * fine; ++c) {
            const double z = 1.0 - 2.0 * (r + 0.5) / (rows * fine), phi = 2.0 * double(pi_f) * (c + 0.5) / (columns * fine);
            const double sine = std::sqrt(1.0 - z * z);
            const Vec3 d{float(sine * std::cos(phi)), float(sine * std::sin(phi)), float(z)};
            const double p = double(environment_pdf(view, d)) * solid_angle;
            expected[cell_of(d)] += p * draws;
            total += p;
        }
    EXPECT_NEAR(total, 1.0, 2e-3);
    double statistic = 0.0;
    int used = 0;
    for (std::size_t i = 0; i < observed.size(); ++i) {
        if (expected[i] < 5.0) continue;
        // The grid's own error adds a little to the statistical variance.
        statistic += (observed[i] - expected[i]) * (observed[i] - expected[i]) / (expected[i] + std::pow(2e-3 * expected[i], 2));
        ++used;
    }
    EXPECT_LT(statistic, chi_square_limit(used - 1));
}

TEST(Environment, StudioDirectionsFollowTheirDensity) {
    EnvironmentDescription description;
    expect_directions_follow_density(make_environment(description));
    description.rotate_deg = 75.0;
    expect_directions_follow_density(make_environment(description));
}

TEST(Environment, ConstantDirectionsAreUniform) {
    EnvironmentDescription description;
    description.kind = EnvironmentKind::constant;
    const EnvironmentMap map = make_environment(description);
    expect_directions_follow_density(map);
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
    EXPECT_INPUT_ERROR(make_environment(description), "texel (2, 1) is -1");
    description.file = folder / "missing.exr";
    EXPECT_INPUT_ERROR(make_environment(description), "no such image file");
}

}  // namespace
}  // namespace opal
