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

TEST(AliasTable, DrawsFollowTheWeights) {
    const std::vector<float> weights = {2.0f, 0.0f, 1.0f, 8.0f, 5.0f};
    const AliasTableData table = make_alias_table(weights);
    constexpr int draws = 1'000'000;
    std::vector<double> count(weights.size(), 0.0);
    for (int i = 0; i < draws; ++i) {
        const RandomBlock block = random_block(3, RandomStream::bench, std::uint64_t(i), 0);
        float within = -1.0f;
        count[std::size_t(table.view().sample(uniform_float(block.value[0]), within))] += 1.0;
        ASSERT_GE(within, 0.0f);
        ASSERT_LT(within, 1.0f);
    }
    double statistic = 0.0;
    EXPECT_EQ(count[1], 0.0);
    for (const std::size_t i : {0, 2, 3, 4}) {
        const double expected = draws * double(weights[i]) / 16.0;
        statistic += (count[i] - expected) * (count[i] - expected) / expected;
    }
    // Three degrees of freedom, probability 1e-6.
    EXPECT_LT(statistic, 30.66);
}

/// What is left of the number within an index is even again.
TEST(AliasTable, RestOfTheNumberIsEven) {
    const AliasTableData table = make_alias_table({2.0f, 0.0f, 1.0f, 8.0f, 5.0f});
    const auto rest = [&](double u) {
        float within = -1.0f;
        table.view().sample(float(u), within);
        return double(within);
    };
    EXPECT_TRUE(density_matches(
        rest, [](double) { return 1.0; }, 0.0, 1.0, 1'000'000, 32));
}

/// Hero and companions, each by itself, follow the density of the light at hand, drawn by inversion and by alias table.
TEST(AliasTable, WavelengthsFollowTheLightTimesTheResponse) {
    for (const double temperature_k : {1500.0, 6500.0})
        for (const bool alias : {false, true}) {
            SpectrumTableOptions options;
            options.illuminant = illuminant_spectrum(IlluminantKind::led, temperature_k);
            options.alias = alias;
            const SpectrumTablesData tables = make_spectrum_tables(options);
            double total = 0.0;
            const auto response = [&](int i) {
                const Vec3 observer = tables.observer[std::size_t(i)];
                return double(observer.x + observer.y + observer.z) * double(tables.white[std::size_t(i)]);
            };
            for (int i = 0; i < 470; ++i) total += 0.5 * (response(i) + response(i + 1));
            const auto density = [&](double wavelength_nm) {
                const int i = std::min(469, int(wavelength_nm) - 360);
                return 0.9 * 0.5 * (response(i) + response(i + 1)) / total + 0.1 / 470.0;
            };
            for (int lane = 0; lane < max_lanes; ++lane)
                EXPECT_TRUE(density_matches(
                    [&](double u) {
                        return double(sample_wavelengths<max_lanes>(tables.view(), float(u), max_lanes).wavelength_nm[lane]);
                    },
                    density, 360.0, 830.0, 200'000, 47))
                    << temperature_k << " K, lane " << lane << (alias ? ", alias" : ", inversion");
            for (const float u : {0.0f, 0.123f, 0.5f, 0.99999994f}) {
                const PathWavelengths<max_lanes> drawn = sample_wavelengths<max_lanes>(tables.view(), u, max_lanes);
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
