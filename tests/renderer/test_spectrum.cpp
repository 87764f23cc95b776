// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "chi_square.h"
#include "formats/colorimetry.h"
#include "renderer/core/path_random.h"
#include "renderer/host/spectrum_tables.h"

namespace opal {
namespace {

Rgb3d rgb_of(const SpectrumTablesData& tables, Rgb color) {
    double x = 0.0, y = 0.0, z = 0.0;
    for (int i = 0; i < spectrum_samples; ++i) {
        const float wavelength = spectrum_min_nm + float(i);
        const double radiance = double(rgb_spectrum(tables.view(), color, wavelength)) * double(tables.white[std::size_t(i)]);
        x += radiance * double(tables.observer[std::size_t(i)].x);
        y += radiance * double(tables.observer[std::size_t(i)].y);
        z += radiance * double(tables.observer[std::size_t(i)].z);
    }
    return linear_srgb_from_xyz({x, y, z});
}

TEST(Spectrum, UpsampledColorsComeBackExactly) {
    const SpectrumTablesData tables = make_spectrum_tables();
    for (const Rgb color : {Rgb{1, 1, 1}, Rgb{1, 0, 0}, Rgb{0, 1, 0}, Rgb{0, 0, 1}, Rgb{0.2f, 0.7f, 0.4f}, Rgb{12, 3, 0.5f}}) {
        const Rgb3d back = rgb_of(tables, color);
        const double scale = std::max({color.r, color.g, color.b});
        EXPECT_NEAR(back.r, double(color.r), 2e-5 * scale);
        EXPECT_NEAR(back.g, double(color.g), 2e-5 * scale);
        EXPECT_NEAR(back.b, double(color.b), 2e-5 * scale);
    }
}

TEST(Spectrum, WavelengthsFollowTheirDensity) {
    const SpectrumTablesData tables = make_spectrum_tables();
    for (int lane = 0; lane < 4; ++lane)
        EXPECT_TRUE(check_inversion(
            fmt::format("wavelength of lane {}", lane), 360.0, 830.0,
            [&](float u) { return sample_wavelengths<4>(tables.view(), u, 4).wavelength_nm[lane]; },
            [&](double wavelength) { return tables.pdf[std::size_t(std::min(469, int(wavelength) - 360))]; }, 94));
    double sum = 0.0;
    for (const float p : tables.pdf) {
        EXPECT_GT(p, 0.0f);
        sum += double(p);
    }
    EXPECT_NEAR(sum, 1.0, 1e-6);
}

TEST(Spectrum, PixelSequenceIsEvenlySpread) {
    // Any 64 consecutive samples leave no sixteenth of the range empty.
    for (std::uint32_t pixel = 0; pixel < 50; ++pixel) {
        int counts[16] = {};
        for (std::uint32_t sample = 0; sample < 64; ++sample)
            ++counts[int(16.0f * PixelSequence(1, pixel, sample + pixel).wavelength())];
        for (const int count : counts) {
            EXPECT_GE(count, 2);
            EXPECT_LE(count, 6);
        }
    }
}

}  // namespace
}  // namespace opal
