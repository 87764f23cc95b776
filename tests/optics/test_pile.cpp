// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "formats/random.h"
#include "renderer/optics/two_beam_block.h"

namespace opal {
namespace {

/// Walks from the front of a pile of `blocks`, each of which turns the light back with probability `reflectance`, until it
/// leaves. Returns the part that leaves at the front.
double walked_reflectance(int blocks, double reflectance, std::int64_t walks) {
    const auto threshold = std::uint64_t(std::llround(reflectance * 0x1p32));
    std::int64_t reflected = 0;
    for (std::int64_t walk = 0; walk < walks; ++walk) {
        int position = 0, step = 1;
        RandomBlock random{};
        for (std::uint32_t n = 0; position >= 0 && position < blocks; ++n) {
            if (n % 4 == 0) random = random_block(11, RandomStream::bench, std::uint64_t(walk), n / 4);
            if (random.value[n % 4] < threshold) step = -step;
            position += step;
        }
        reflected += position < 0 ? 1 : 0;
    }
    return double(reflected) / double(walks);
}

/// Within 1 % of the reflectance; as many walks as make that four standard errors.
TEST(Pile, AgreesWithTheRandomWalkBetweenTwoBeams) {
    constexpr double tolerance = 0.01, standard_error = tolerance / 4.0;
    for (const double reflectance : {0.01, 0.1, 0.6})
        for (const int blocks : {1, 2, 5, 20, 50, 100, 200}) {
            const double expected = pile_reflectance(reflectance, blocks);
            const double walks = std::max(1.0e4, (1.0 - expected) / (expected * standard_error * standard_error));
            EXPECT_NEAR(walked_reflectance(blocks, reflectance, std::int64_t(walks)), expected, tolerance * expected)
                << blocks << " blocks of " << reflectance;
        }
}

TEST(Pile, OneBlockIsItselfAndManyReflectAll) {
    EXPECT_DOUBLE_EQ(pile_reflectance(0.37, 1.0), 0.37);
    EXPECT_DOUBLE_EQ(pile_reflectance(0.0, 50.0), 0.0);
    EXPECT_DOUBLE_EQ(pile_reflectance(1.0, 50.0), 1.0);
    EXPECT_NEAR(pile_reflectance(0.5, 1.0e9), 1.0, 1e-8);
}

}  // namespace
}  // namespace opal
