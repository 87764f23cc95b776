// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "pareto/spectral_lines.h"
#include "renderer/host/spectrum_tables.h"

namespace opal {
namespace {

/// What many drawn wavelengths of the light itself show: the colour of white.
Xyz color_of_white(SpectralChoice choice, int companions, std::set<int>* drawn_nm = nullptr) {
    const SpectrumTablesData data = make_spectrum_tables();
    const SpectralLines lines(data.view(), choice);
    SpectrumTables tables = data.view();
    lines.confine(tables);
    Xyz sum{0.0, 0.0, 0.0};
    constexpr int draws = 48 * 3 * 1000;
    for (int i = 0; i < draws; ++i) {
        const auto wavelengths = sample_wavelengths<4>(tables, (float(i) + 0.5f) / float(draws), 1 + companions);
        for (int lane = 0; lane < wavelengths.count; ++lane) {
            const float wavelength_nm = wavelengths.wavelength_nm[lane];
            // Just below a whole number they may be rounded to it.
            if (drawn_nm && float(int(wavelength_nm)) != wavelength_nm) drawn_nm->insert(int(wavelength_nm));
            const Xyz color = lines.color(tables, wavelength_nm, wavelengths.pdf_per_nm[lane]);
            const double radiance = double(table_at(tables.white, wavelength_nm)) / wavelengths.count / draws;
            sum = {sum.x + radiance * color.x, sum.y + radiance * color.y, sum.z + radiance * color.z};
        }
    }
    return sum;
}

TEST(SpectralLines, ThreeLinesShowWhite) {
    std::set<int> drawn_nm;
    const Xyz white = color_of_white(SpectralChoice::rgb, 2, &drawn_nm);
    // The light varies by up to 1 % within a line of 2 nm.
    EXPECT_NEAR(white.x, srgb_white.x, 0.005);
    EXPECT_NEAR(white.y, 1.0, 0.005);
    EXPECT_NEAR(white.z, srgb_white.z, 0.005);
    EXPECT_EQ(drawn_nm, (std::set<int>{464, 465, 549, 550, 609, 610}));
}

TEST(SpectralLines, FortyEightLinesShowWhite) {
    std::set<int> drawn_nm;
    const Xyz white = color_of_white(SpectralChoice::bins_10nm, 0, &drawn_nm);
    // D65 has structure of some 10 nm, which lines do not see: half a percent.
    EXPECT_NEAR(white.x, srgb_white.x, 0.01);
    EXPECT_NEAR(white.y, 1.0, 0.01);
    EXPECT_NEAR(white.z, srgb_white.z, 0.01);
    EXPECT_EQ(drawn_nm.size(), 2u * 48u - 2u);
    for (const int nm : drawn_nm) EXPECT_TRUE(nm % 10 == 0 || nm % 10 == 9) << nm;
}

TEST(SpectralLines, AContinuousSpectrumIsLeftAlone) {
    const Xyz white = color_of_white(SpectralChoice::continuous, 3);
    EXPECT_NEAR(white.x, srgb_white.x, 0.001);
    EXPECT_NEAR(white.y, 1.0, 0.001);
    EXPECT_NEAR(white.z, srgb_white.z, 0.001);
}

}  // namespace
}  // namespace opal
