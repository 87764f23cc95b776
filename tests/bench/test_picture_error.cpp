// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "formats/random.h"
#include "pareto/picture_error.h"

namespace opal {
namespace {

constexpr std::size_t num_pixels = 20, num_seeds = 8;
constexpr double noise = 0.5, bias = 0.2;

/// A normal deviate (Box-Muller).
double normal(std::uint64_t seed, std::uint64_t index) {
    const RandomBlock block = random_block(seed, RandomStream::bench, index, 0);
    const double u = 1.0 - uniform_double(block.value[0], block.value[1]), v = uniform_double(block.value[2], block.value[3]);
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::acos(-1.0) * v);
}

/// Pixels of luminance 1 (`colour` on the second component) with independent noise in each component.
SeedPictures pictures(std::uint64_t seed, double luminance, double colour) {
    SeedPictures pictures(num_seeds, std::vector<Opponent>(num_pixels));
    for (std::size_t k = 0; k < num_seeds; ++k)
        for (std::size_t p = 0; p < num_pixels; ++p)
            for (std::size_t c = 0; c < 3; ++c)
                pictures[k][p][c] =
                    (c == 0 ? luminance : (c == 1 ? colour : 0.0)) + noise * normal(seed, (k * num_pixels + p) * 3 + c);
    return pictures;
}

struct Repeated {
    double mean = 0.0, spread = 0.0, mean_square_error = 0.0;  ///< of the estimates; of their standard errors' squares
};

template <class Measure>
Repeated repeat(int times, const Measure& measure) {
    double sum = 0.0, square = 0.0, claimed = 0.0;
    for (int i = 0; i < times; ++i) {
        const Estimate estimate = measure(std::uint64_t(i));
        sum += estimate.value;
        square += estimate.value * estimate.value;
        claimed += estimate.standard_error * estimate.standard_error;
    }
    return {sum / times, std::sqrt((square - sum * sum / times) / (times - 1)), claimed / times};
}

constexpr int times = 2000;

/// Independent noise of both pictures: the mean is the squared bias itself, 0.2^2 in luminance and 0.1^2 in colour, over 1.1.
TEST(PictureError, SquaredBiasHasNoBiasFromNoise) {
    const std::vector<double> weights(num_pixels, 1.0 / (1.1 * num_pixels));
    const Repeated found = repeat(times, [&](std::uint64_t i) {
        return squared_bias(pictures(2 * i, 1.0 + bias, 0.1), pictures(2 * i + 1, 1.0, 0.0), weights);
    });
    EXPECT_NEAR(found.mean, (bias * bias + 0.01) / 1.1, 4.0 * found.spread / std::sqrt(double(times)));
}

/// Where there is no bias only products of noise are left, of which the jackknife claims 2 (n - 1) / (n - 2) times the variance
/// for n seeds (by counting pairs): on the safe side.
TEST(PictureError, SquaredBiasThatIsNotThere) {
    const std::vector<double> weights(num_pixels, 1.0 / num_pixels);
    const Repeated found = repeat(
        times, [&](std::uint64_t i) { return squared_bias(pictures(2 * i, 1.0, 0.0), pictures(2 * i + 1, 1.0, 0.0), weights); });
    EXPECT_NEAR(found.mean, 0.0, 4.0 * found.spread / std::sqrt(double(times)));
    EXPECT_NEAR(std::sqrt(found.mean_square_error) / found.spread, std::sqrt(2.0 * (num_seeds - 1.0) / (num_seeds - 2.0)), 0.1);
}

TEST(PictureError, EqualPicturesHaveNone) {
    const SeedPictures picture = pictures(1, 1.0, 0.0);
    const Estimate estimate = squared_bias(picture, picture, relative_weights(picture));
    EXPECT_EQ(estimate.value, 0.0);
    EXPECT_EQ(estimate.standard_error, 0.0);
}

/// Three components with a variance of 0.25 each.
TEST(PictureError, VarianceOfASeed) {
    const std::vector<double> weights(num_pixels, 1.0 / num_pixels);
    const Repeated found = repeat(times, [&](std::uint64_t i) { return seed_variance(pictures(i, 1.0, 0.0), weights); });
    EXPECT_NEAR(found.mean, 3.0 * noise * noise, 4.0 * found.spread / std::sqrt(double(times)));
    // A part 1 / n of the variance of a normal sample's variance comes from products of two seeds, which count as above.
    const double n = num_seeds;
    EXPECT_NEAR(std::sqrt(found.mean_square_error) / found.spread, std::sqrt((n - 1.0 + 2.0 * (n - 1.0) / (n - 2.0)) / n), 0.06);
}

TEST(PictureError, MeanOfALargerPicture) {
    const Repeated found = repeat(
        times, [&](std::uint64_t i) { return relative_mean_error(pictures(2 * i, 1.2, 0.0), pictures(2 * i + 1, 1.0, 0.0)); });
    // A ratio of means of 160 values with a standard deviation of 0.5: its own bias is 1.2 * 0.25 / 160.
    EXPECT_NEAR(found.mean, 0.2 + 1.2 * 0.25 / 160.0, 4.0 * found.spread / std::sqrt(double(times)));
    EXPECT_NEAR(std::sqrt(found.mean_square_error) / found.spread, 1.0, 0.1);
}

TEST(PictureError, WeightsAreRelativeButInTheDark) {
    SeedPictures picture(2, std::vector<Opponent>(2));
    for (auto& seed : picture) seed = {Opponent{3.0, 0.0, 0.0}, Opponent{1.0, 0.0, 0.0}};
    const std::vector<double> weights = relative_weights(picture);
    EXPECT_NEAR(weights[0], 0.5 / (9.0 + 0.5), 1e-12);  // a tenth of the mean of 9 and 1
    EXPECT_NEAR(weights[1], 0.5 / (1.0 + 0.5), 1e-12);
}

/// Six pixels of a picture four wide in patches of two by two: the first patch has three of its four, the second two, the third
/// one.
TEST(PictureError, PatchesOfHalfTheirPixels) {
    const std::vector<std::uint32_t> pixels = {0, 1, 5, 2, 6, 8};
    const Patches patches = patches_of(pixels, 4, 2);
    ASSERT_EQ(patches.size(), 2u);
    EXPECT_EQ(patches[0], (std::vector<std::size_t>{0, 1, 2}));
    EXPECT_EQ(patches[1], (std::vector<std::size_t>{3, 4}));
    const SeedPictures means = patch_means({{{3, 0, 0}, {6, 0, 0}, {9, 0, 0}, {1, 0, 0}, {2, 0, 0}, {50, 0, 0}}}, patches);
    EXPECT_NEAR(means[0][0][0], 6.0, 1e-12);
    EXPECT_NEAR(means[0][1][0], 1.5, 1e-12);
}

}  // namespace
}  // namespace opal
