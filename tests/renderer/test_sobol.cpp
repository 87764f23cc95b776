// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "chi_square.h"
#include "renderer/core/path_random.h"

namespace opal {
namespace {

/// The first points in the order of the index, by hand from the polynomials x + 1, x^2 + x + 1, x^3 + x + 1 of Joe & Kuo's
/// table (their program lists them in Gray code's order).
TEST(Sobol, FirstPoints) {
    const double expected[8][4] = {{0, 0, 0, 0},
                                   {0.5, 0.5, 0.5, 0.5},
                                   {0.25, 0.75, 0.75, 0.75},
                                   {0.75, 0.25, 0.25, 0.25},
                                   {0.125, 0.625, 0.375, 0.125},
                                   {0.625, 0.125, 0.875, 0.625},
                                   {0.375, 0.375, 0.625, 0.875},
                                   {0.875, 0.875, 0.125, 0.375}};
    for (std::uint32_t i = 0; i < 8; ++i)
        for (int d = 0; d < 4; ++d) EXPECT_EQ(double(sobol_point(i).value[d]) * 0x1p-32, expected[i][d]) << i << ' ' << d;
}

/// Numbers 0 to 7 of the paths through one pixel; 3 is left out after the three that come before the path.
std::vector<double> numbers(std::uint32_t pixel, std::uint32_t sample, PathSampler sampler) {
    PathRandom random(7, pixel, sample, sampler);
    const PixelNumbers first = random.pixel_numbers();
    std::vector<double> result = {double(first.wavelength), double(first.x), double(first.y)};
    for (int k = 0; k < 5; ++k) result.push_back(double(random.next()));
    return result;
}

/// Any aligned run of 16 samples has one in every sixteenth of each number, and one in each 4 x 4 cell of the first two: a (0,
/// 4, 2)-net, whatever the scramble.
TEST(Sobol, AlignedRunsAreNets) {
    for (std::uint32_t pixel = 0; pixel < 20; ++pixel)
        for (const std::uint32_t begin : {0u, 16u, 1040u}) {
            std::vector<std::set<int>> strata(8);
            std::set<int> cells;
            for (std::uint32_t i = begin; i < begin + 16; ++i) {
                const std::vector<double> x = numbers(pixel, i, PathSampler::sobol);
                for (std::size_t k = 0; k < 8; ++k) strata[k].insert(int(x[k] * 16.0));
                cells.insert(int(x[0] * 4.0) * 4 + int(x[1] * 4.0));
            }
            for (const std::set<int>& stratum : strata) EXPECT_EQ(stratum.size(), 16u);
            EXPECT_EQ(cells.size(), 16u);
        }
}

/// Over the scrambles of many pixels every pair of numbers is uniform: of one sample, and of one number in two samples but for
/// what stratification forbids.
TEST(Sobol, ScramblesAreUniform) {
    for (const auto& [first, second] : {std::pair(0, 1), std::pair(1, 2), std::pair(0, 4), std::pair(5, 6)}) {
        std::uint32_t pixel = 0;
        EXPECT_TRUE(check_sampler(
            "two numbers of one sample", SamplerDomain<2>{{0.0, 0.0}, {1.0, 1.0}, {24, 24}},
            [&](SamplerRandom&) {
                const std::vector<double> x = numbers(pixel++, 5, PathSampler::sobol);
                return SamplerPoint<2>{x[std::size_t(first)], x[std::size_t(second)]};
            },
            [](SamplerPoint<2>) { return 1.0; }, 200'000));
    }
    // Samples 0 and 1 are in different halves; elsewhere they know nothing of each other.
    std::uint32_t pixel = 0;
    EXPECT_TRUE(check_sampler(
        "one number of two samples", SamplerDomain<2>{{0.0, 0.0}, {1.0, 1.0}, {24, 24}},
        [&](SamplerRandom&) {
            const std::uint32_t p = pixel++;
            return SamplerPoint<2>{numbers(p, 0, PathSampler::sobol)[0], numbers(p, 1, PathSampler::sobol)[0]};
        },
        [](SamplerPoint<2> x) { return (x[0] < 0.5) != (x[1] < 0.5) ? 2.0 : 0.0; }, 200'000));
}

/// The error of a smooth integral falls faster than independent numbers' 1/sqrt(n): at 256 samples at least 8 times smaller (8
/// times the square root is what 1/n would give from 4 on).
TEST(Sobol, IntegratesSmoothFunctionsFaster) {
    const auto error = [](PathSampler sampler) {
        double squares = 0.0;
        for (std::uint32_t pixel = 0; pixel < 200; ++pixel) {
            double sum = 0.0;
            for (std::uint32_t i = 0; i < 256; ++i) {
                const std::vector<double> x = numbers(pixel, i, sampler);
                sum += std::sin(3.0 * x[0]) * (x[1] + 0.5) * std::exp(-x[2]);
            }
            const double exact = (1.0 - std::cos(3.0)) / 3.0 * (1.0 - std::exp(-1.0));
            squares += (sum / 256.0 - exact) * (sum / 256.0 - exact);
        }
        return std::sqrt(squares / 200.0);
    };
    EXPECT_LT(8.0 * error(PathSampler::sobol), error(PathSampler::independent));
}

}  // namespace
}  // namespace opal
