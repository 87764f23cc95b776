// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>

#include "chi_square.h"

namespace opal {
namespace {

/// The harness itself, in one dimension: p(x) = 2 x on [0, 1], drawn by x = sqrt(u).
::testing::AssertionResult check_line(double stretch, const std::function<double(double)>& density) {
    return check_inversion(
        "2 x", 0.0, 1.0, [&](float u) { return stretch * std::sqrt(double(u)); }, density);
}

TEST(ChiSquareHarness, AcceptsTheRightDensity) {
    EXPECT_TRUE(check_line(1.0, [](double x) { return 2.0 * x; }));
}

TEST(ChiSquareHarness, RejectsADensityWrongByTwoPercent) {
    EXPECT_FALSE(check_line(1.0, [](double x) { return 1.02 * 2.0 * x; }));
    // Too large by 2 % where one point in two falls, too small elsewhere: the integral stays 1.
    EXPECT_FALSE(check_line(1.0, [](double x) { return 2.0 * x * (x * x < 0.5 ? 1.02 : 0.98); }));
    EXPECT_FALSE(check_line(1.0, [](double x) { return 2.0 * x * (1.0 + 0.02 * std::sin(20.0 * x)) / 0.999275; }));
    // A sampler whose values are 1 % too small has a density 2 % too large.
    EXPECT_FALSE(check_line(0.99, [](double x) { return 2.0 * x; }));
}

TEST(ChiSquareHarness, RejectsWhatFallsOutside) {
    EXPECT_FALSE(check_line(1.0001, [](double x) { return 2.0 * x; }));
    EXPECT_FALSE(check_line(std::nan(""), [](double x) { return 2.0 * x; }));
}

/// In two dimensions: p(x, y) = 4 x y on the unit square.
::testing::AssertionResult check_square(double correlation, const std::function<double(double, double)>& density) {
    return check_sampler(
        "4 x y", SamplerDomain<2>{{0.0, 0.0}, {1.0, 1.0}, {16, 16}},
        [&](SamplerRandom& random) {
            const double x = std::sqrt(double(random.next())), y = std::sqrt(double(random.next()));
            return SamplerPoint<2>{x, random.next() < correlation ? x : y};
        },
        [&](SamplerPoint<2> p) { return density(p[0], p[1]); });
}

TEST(ChiSquareHarness, AcceptsTheRightDensityInTwoDimensions) {
    EXPECT_TRUE(check_square(0.0, [](double x, double y) { return 4.0 * x * y; }));
}

TEST(ChiSquareHarness, RejectsADensityWrongByTwoPercentInTwoDimensions) {
    EXPECT_FALSE(check_square(0.0, [](double x, double y) { return 1.02 * 4.0 * x * y; }));
    EXPECT_FALSE(check_square(0.0, [](double x, double y) { return 4.0 * x * y * (x * x < 0.5 ? 1.02 : 0.98); }));
    EXPECT_FALSE(
        check_square(0.0, [](double x, double y) { return 4.0 * x * y * ((x * x < 0.5) == (y * y < 0.5) ? 1.02 : 0.98); }));
    // Each axis by itself is right, their connection is not.
    EXPECT_FALSE(check_square(0.02, [](double x, double y) { return 4.0 * x * y; }));
}

TEST(ChiSquareHarness, TailProbabilities) {
    // Tables of the distribution: upper 5 % and 0.1 % points (Abramowitz & Stegun 1964, table 26.8), printed to six digits.
    EXPECT_NEAR(chi_square_tail(18.3070, 10), 0.05, 1.0e-6);
    EXPECT_NEAR(chi_square_tail(29.5883, 10), 0.001, 1.0e-8);
    EXPECT_NEAR(chi_square_tail(32.6705, 21), 0.05, 1.0e-6);
    EXPECT_NEAR(chi_square_tail(149.449, 100), 0.001, 1.0e-7);
}

TEST(ChiSquareHarness, CellsAreIntegratedAdaptively) {
    // A peak of width 1e-3, and a step that no cell is aligned with.
    const auto peak = [](SamplerPoint<1> p) { return 1.0e-3 / (3.14159265358979 * (p[0] * p[0] + 1.0e-6)); };
    EXPECT_NEAR(chi_square_detail::integrate<1>(peak, {-1.0}, {1.0}, 1.0e-6, 14), 2.0 * std::atan(1.0e3) / 3.14159265358979,
                1e-5);
    const auto disc = [](SamplerPoint<2> p) { return p[0] * p[0] + p[1] * p[1] < 1.0 ? 1.0 : 0.0; };
    double area = 0.0;
    for (int i = 0; i < 256; ++i) {
        const double x = i % 16 / 16.0, y = i / 16 / 16.0;
        area += chi_square_detail::integrate<2>(disc, {x, y}, {x + 1.0 / 16, y + 1.0 / 16}, 1.0e-6, 7);
    }
    EXPECT_NEAR(area, 0.25 * 3.14159265358979, 1e-4);
}

}  // namespace
}  // namespace opal
