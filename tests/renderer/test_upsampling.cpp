// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "color_round_trip.h"
#include "formats/random.h"
#include "renderer/host/sigmoid_table.h"

namespace opal {
namespace {

SpectrumTablesData tables_for(Upsampling upsampling) {
    SpectrumTableOptions options;
    options.upsampling = upsampling;
    return make_spectrum_tables(options);
}

/// dE*ab (1976) of every colour of a cube, through its spectrum under D65 and back.
std::vector<double> round_trip_errors(const SpectrumTablesData& tables, const std::vector<Rgb>& colors) {
    std::vector<double> errors;
    for (const Rgb color : colors) {
        const Lab back = lab_of(tables, reflectance_table(tables, color));
        errors.push_back(delta_e_76(back, lab_of({double(color.r), double(color.g), double(color.b)})));
    }
    return errors;
}

/// The sigmoid's own error and its table's: at most dE 1 over the whole cube, corners and edges included. A cube of 12 values
/// shares no node with the table but black and white.
TEST(Upsampling, JakobHanikaRoundTrip) {
    const ErrorStatistics errors = statistics_of(round_trip_errors(tables_for(Upsampling::jakob_hanika), srgb_cube(12)));
    EXPECT_LT(errors.max, 1.0);
    EXPECT_LT(errors.percentile_95, 0.5);
}

TEST(Upsampling, BasisRoundTripIsExact) {
    // Single precision, 6e-8 of full scale, at Lab's steepest, 903 per unit of Y and more for a* and b*.
    EXPECT_LT(statistics_of(round_trip_errors(tables_for(Upsampling::basis), srgb_cube(9))).max, 2e-4);
}

/// Smits' spectra are for an equal-energy white and ten bins: the published method misses by 2 dE in the mean and up to 5 under
/// D65, twenty times as much as Jakob and Hanika's. A bin's width of shift would be far outside.
TEST(Upsampling, SmitsRoundTripIsWhatTenBinsAllow) {
    const ErrorStatistics smits = statistics_of(round_trip_errors(tables_for(Upsampling::smits), srgb_cube(9)));
    const ErrorStatistics sigmoid = statistics_of(round_trip_errors(tables_for(Upsampling::jakob_hanika), srgb_cube(9)));
    EXPECT_GT(smits.mean, 10.0 * sigmoid.mean);
    EXPECT_LT(smits.max, 6.0);
}

/// Smits' method by hand: (0.2, 0.7, 0.4) is 0.2 white + 0.2 cyan + 0.3 green.
TEST(Upsampling, SmitsDecomposition) {
    const SpectrumTablesData tables = tables_for(Upsampling::smits);
    const UpsampledColor color = upsample_reflectance(tables.upsampling, {0.2f, 0.7f, 0.4f});
    // Bin 3 is 482 to 516 nm.
    EXPECT_NEAR(upsampled(tables.view(), color, 500.0f), 0.2f * 0.9993f + 0.2f * 1.0007f + 0.3f * 0.7937f, 1e-6f);
    EXPECT_NEAR(upsampled(tables.view(), color, 370.0f), 0.2f * 1.0f + 0.2f * 0.971f, 1e-6f);
    EXPECT_NEAR(upsampled(tables.view(), color, 800.0f), 0.2f * 1.0f + 0.3f * 0.0025f, 1e-6f);
    const UpsampledColor purple = upsample_reflectance(tables.upsampling, {0.9f, 0.1f, 0.5f});
    EXPECT_NEAR(upsampled(tables.view(), purple, 640.0f), 0.1f + 0.4f * 1.0f + 0.4f * 1.0149f, 1e-5f);
}

TEST(Upsampling, ReflectancesStayWithinZeroAndOne) {
    for (const Upsampling method : {Upsampling::jakob_hanika, Upsampling::smits, Upsampling::basis}) {
        const SpectrumTablesData tables = tables_for(method);
        for (const Rgb color : srgb_cube(9))
            for (const double value : reflectance_table(tables, color)) {
                ASSERT_GE(value, 0.0);
                ASSERT_LE(value, 1.0 + 1e-6);
            }
    }
}

/// Greys are the same at every wavelength, so that white furnaces stay white and black stays black.
TEST(Upsampling, GreysAreFlat) {
    const SpectrumTablesData tables = tables_for(Upsampling::jakob_hanika);
    for (const float value : {0.0f, 1.0e-4f, 0.18f, 0.5f, 0.97f, 1.0f})
        for (const double reflectance : reflectance_table(tables, {value, value, value}))
            ASSERT_NEAR(reflectance, double(value), 2e-7) << value;
}

/// The generator's table itself: its nodes solve the equations to the generator's own limit of dE 1e-4. From the fifth lightness
/// up, 0.006; below, the limit of the coefficients keeps saturated colours from their full darkness.
TEST(Upsampling, TableSolvesItsNodes) {
    const SpectrumTablesData tables = tables_for(Upsampling::jakob_hanika);
    constexpr int n = sigmoid_table_resolution;
    double largest_error = 0.0;
    for (int part = 0; part < 3; ++part)
        for (int k = 4; k < n; k += 3)
            for (int j = 0; j < n; j += 5)
                for (int i = 0; i < n; i += 5) {
                    const float* const node = sigmoid_table().data() + 3 * (((part * n + k) * n + j) * n + i);
                    const UpsampledColor color{{node[0], node[1], node[2]}, 1.0f};
                    ReflectanceTable reflectance;
                    for (std::size_t w = 0; w < reflectance.size(); ++w)
                        reflectance[w] = double(upsampled(tables.view(), color, 360.0f + float(w)));
                    double rgb[3];
                    rgb[part] = sigmoid_table_lightness(k);
                    rgb[(part + 1) % 3] = rgb[part] * sigmoid_table_ratio(i);
                    rgb[(part + 2) % 3] = rgb[part] * sigmoid_table_ratio(j);
                    largest_error =
                        std::max(largest_error, delta_e_76(lab_of(tables, reflectance), lab_of({rgb[0], rgb[1], rgb[2]})));
                }
    // Evaluation in single precision adds a few 1e-7 of full scale, 903 dE per unit in the dark.
    EXPECT_LT(largest_error, 2e-3);
}

/// Neighbouring colours have neighbouring spectra: no jump where the largest component changes or at the edges of cells.
TEST(Upsampling, SpectraAreContinuousInTheColor) {
    const SpectrumTablesData tables = tables_for(Upsampling::jakob_hanika);
    for (int trial = 0; trial < 200; ++trial) {
        const RandomBlock block = random_block(5, RandomStream::bench, std::uint64_t(trial), 0);
        const Rgb color{0.05f + 0.9f * uniform_float(block.value[0]), 0.05f + 0.9f * uniform_float(block.value[1]),
                        0.05f + 0.9f * uniform_float(block.value[2])};
        // Red and green almost equal, one then the other larger.
        const float top = max_of(color.r, max_of(color.g, color.b));
        const ReflectanceTable a = reflectance_table(tables, {top, top - 1e-5f, color.b});
        const ReflectanceTable b = reflectance_table(tables, {top - 1e-5f, top, color.b});
        for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], 2e-3);
    }
}

/// Any radiance: scaled colours have scaled spectra, and nothing exceeds the light's brightest colour.
TEST(Upsampling, RadianceIsUnboundedAndHomogeneous) {
    for (const Upsampling method : {Upsampling::jakob_hanika, Upsampling::smits, Upsampling::basis}) {
        const SpectrumTablesData tables = tables_for(method);
        const UpsampledColor one = upsample_radiance(tables.upsampling, {0.9f, 0.3f, 0.05f});
        const UpsampledColor many = upsample_radiance(tables.upsampling, {900.0f, 300.0f, 50.0f});
        const UpsampledColor none = upsample_radiance(tables.upsampling, {0.0f, 0.0f, 0.0f});
        for (float wavelength_nm = 360.0f; wavelength_nm <= 830.0f; wavelength_nm += 10.0f) {
            const float value = upsampled(tables.view(), one, wavelength_nm);
            EXPECT_NEAR(upsampled(tables.view(), many, wavelength_nm), 1000.0f * value, 0.1f * value + 1e-4f);
            EXPECT_LE(value, 1.81f);
            EXPECT_GE(value, 0.0f);
            EXPECT_EQ(upsampled(tables.view(), none, wavelength_nm), 0.0f);
        }
    }
}

/// Light of colour (1, 1, 1) is the illuminant itself: exactly but for Smits, whose white is 1 to 8e-4.
TEST(Upsampling, WhiteRadianceIsTheIlluminant) {
    for (const Upsampling method : {Upsampling::jakob_hanika, Upsampling::smits, Upsampling::basis}) {
        const SpectrumTablesData tables = tables_for(method);
        const UpsampledColor white = upsample_radiance(tables.upsampling, {1.0f, 1.0f, 1.0f});
        const double tolerance = method == Upsampling::smits ? 8.1e-4 : 1e-6;
        for (float wavelength_nm = 360.0f; wavelength_nm <= 830.0f; wavelength_nm += 1.0f)
            ASSERT_NEAR(upsampled(tables.view(), white, wavelength_nm), 1.0, tolerance);
    }
}

}  // namespace
}  // namespace opal
