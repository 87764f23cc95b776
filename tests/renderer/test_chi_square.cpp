// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "chi_square.h"

namespace opal {
namespace {

/// The harness itself: p(x) = 2x on [0, 1], drawn by x = sqrt(u).
TEST(ChiSquareHarness, AcceptsTheRightDensity) {
    EXPECT_TRUE(density_matches([](double u) { return std::sqrt(u); }, [](double x) { return 2.0 * x; }, 0.0, 1.0));
}

TEST(ChiSquareHarness, RejectsADensityWrongByTwoPercent) {
    const auto sample = [](double u) { return std::sqrt(u); };
    EXPECT_FALSE(density_matches(
        sample, [](double x) { return 1.02 * 2.0 * x; }, 0.0, 1.0));
    EXPECT_FALSE(density_matches(
        sample, [](double x) { return 2.0 * x * (x < 0.5 ? 1.02 : (1.0 - 0.02 / 3.0)); }, 0.0, 1.0));
    EXPECT_FALSE(density_matches([](double u) { return 1.01 * std::sqrt(u); }, [](double x) { return 2.0 * x; }, 0.0, 1.0));
}

}  // namespace
}  // namespace opal
