// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "renderer/core/exponential.h"

namespace opal {
namespace {

TEST(Exponential, HasSinglePrecision) {
    double worst = 0.0;
    for (double x = -86.9; x < 88.0; x += 1.1e-4)
        worst = std::max(worst, std::abs(double(exponential(float(x))) / std::exp(double(float(x))) - 1.0));
    EXPECT_LT(worst, 3.0e-7);
}

TEST(Exponential, VanishesWhereNothingIsLeft) {
    for (const float x : {-87.1f, -1.0e3f, -3.0e38f}) EXPECT_EQ(exponential(x), 0.0f) << x;
    EXPECT_EQ(exponential(0.0f), 1.0f);
    EXPECT_TRUE(std::isfinite(exponential(3.0e38f)));
}

TEST(Exponential, LogarithmHasSinglePrecision) {
    double worst = 0.0;
    for (std::uint32_t bits = 0x00800000u; bits < 0x7F800000u; bits += 2111u) {
        const float x = std::bit_cast<float>(bits);
        worst = std::max(worst, std::abs(double(logarithm(x)) / std::log(double(x)) - 1.0));
    }
    EXPECT_LT(worst, 3.0e-7);
    EXPECT_EQ(logarithm(1.0f), 0.0f);
}

/// Near 1 the logarithm is small: its relative error decides short flights.
TEST(Exponential, FreeDepthIsExactForSmallNumbers) {
    for (int n = 0; n < 4096; ++n) {
        const float u = float(n) * 0x1p-24f;
        const double depth = -std::log1p(-double(u));
        EXPECT_NEAR(double(free_depth(u)), depth, 3.0e-7 * depth) << u;
    }
}

}  // namespace
}  // namespace opal
