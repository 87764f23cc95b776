// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "chi_square.h"
#include "renderer/host/spectrum_tables.h"

namespace opal {
namespace {

/// The probability that the columns give each index is the weight's share, to the rounding of the columns.
TEST(AliasTable, ColumnsHoldTheWeightsShares) {
    const std::vector<float> weights = {0.0f, 3.0f, 1.0f, 0.25f, 0.0f, 10.0f, 0.5f};
    const AliasTableData table = make_alias_table(weights);
    std::vector<double> probability(weights.size(), 0.0);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        probability[i] += double(table.columns[i].keep) / double(weights.size());
        probability[std::size_t(table.columns[i].other)] += (1.0 - double(table.columns[i].keep)) / double(weights.size());
    }
    for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_NEAR(probability[i], double(weights[i]) / 14.75, 1e-7) << i;
}

/// The index follows the weights, and what is left of the number is even within each.
TEST(AliasTable, DrawsFollowTheWeights) {
    const std::vector<float> weights = {2.0f, 0.0f, 1.0f, 8.0f, 5.0f, 0.5f, 3.5f, 0.0f, 4.0f};
    const AliasTableData table = make_alias_table(weights);
    EXPECT_TRUE(check_inversion(
        "alias table", 0.0, 9.0,
        [&](float u) {
            float within = -1.0f;
            const int index = table.view().sample(u, within);
            EXPECT_GT(weights[std::size_t(index)], 0.0f);
            return double(index) + double(within);
        },
        [&](double x) { return double(weights[std::size_t(std::min(8.0, x))]) / 24.0; }, 72));
}

/// Hero and companions, each by itself, follow nine parts of light times response and one of uniform, whatever the light.
TEST(AliasTable, WavelengthsFollowTheLightTimesTheResponse) {
    SpectrumTableOptions options;
    options.illuminant = illuminant_spectrum(IlluminantKind::led, 2700.0);
    for (const bool alias : {false, true}) {
        options.alias = alias;
        const SpectrumTablesData tables = make_spectrum_tables(options);
        std::vector<double> response;
        for (std::size_t i = 0; i < tables.white.size(); ++i) {
            const Vec3 observer = tables.observer[i];
            response.push_back(double(observer.x + observer.y + observer.z) * options.illuminant.value[i]);
        }
        double total = 0.0;
        for (std::size_t i = 0; i < 470; ++i) total += 0.5 * (response[i] + response[i + 1]);
        const auto density = [&](SamplerPoint<1> wavelength_nm) {
            const std::size_t i = std::min<std::size_t>(469, std::size_t(wavelength_nm[0] - 360.0));
            return 0.9 * 0.5 * (response[i] + response[i + 1]) / total + 0.1 / 470.0;
        };
        for (const int lane : {0, 1, 6})
            EXPECT_TRUE(check_sampler(
                fmt::format("lane {} of an LED's light, {}", lane, alias ? "alias table" : "inversion"),
                SamplerDomain<1>{{360.0}, {830.0}, {94}},
                [&](SamplerRandom& random) {
                    const auto drawn = sample_wavelengths<max_lanes>(tables.view(), random.next(), max_lanes);
                    return SamplerPoint<1>{double(drawn.wavelength_nm[lane])};
                },
                density, 300'000));
        for (const float u : {0.0f, 0.123f, 0.5f, 0.99999994f}) {
            const auto drawn = sample_wavelengths<max_lanes>(tables.view(), u, max_lanes);
            for (int lane = 0; lane < max_lanes; ++lane)
                EXPECT_EQ(drawn.pdf_per_nm[lane], tables.pdf[std::size_t(drawn.wavelength_nm[lane] - 360.0f)]);
        }
    }
}

/// Whichever way the hero is drawn, its companions cut the density into equal shares.
TEST(AliasTable, CompanionsAreSpreadEvenly) {
    SpectrumTableOptions options;
    options.alias = true;
    const SpectrumTablesData tables = make_spectrum_tables(options);
    const auto place = [&](float wavelength_nm) {
        const std::size_t i = std::size_t(wavelength_nm - 360.0f);
        return tables.cdf[i] + (wavelength_nm - 360.0f - float(i)) * tables.pdf[i];
    };
    for (const float u : {0.02f, 0.31f, 0.77f}) {
        const PathWavelengths<4> drawn = sample_wavelengths<4>(tables.view(), u, 4);
        for (int lane = 1; lane < 4; ++lane) {
            const float turn = place(drawn.wavelength_nm[lane]) - place(drawn.wavelength_nm[0]) + 1.0f;
            EXPECT_NEAR(turn - std::floor(turn), 0.25f * float(lane), 1e-5f);
        }
    }
}

/// Inversion keeps the order of the numbers, and so their strata; the alias table does not.
TEST(AliasTable, OnlyInversionIsMonotone) {
    SpectrumTableOptions options;
    for (const bool alias : {false, true}) {
        options.alias = alias;
        const SpectrumTablesData tables = make_spectrum_tables(options);
        bool monotone = true;
        float previous = 0.0f;
        for (int i = 0; i < 1000; ++i) {
            const float wavelength_nm = sample_wavelengths<1>(tables.view(), (float(i) + 0.5f) / 1000.0f, 1).wavelength_nm[0];
            monotone &= wavelength_nm >= previous;
            previous = wavelength_nm;
        }
        EXPECT_EQ(monotone, !alias);
    }
}

}  // namespace
}  // namespace opal
