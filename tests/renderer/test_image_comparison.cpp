// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "../formats/expect_error.h"
#include "formats/random.h"
#include "renderer/host/image_comparison.h"

namespace opal {
namespace {

constexpr int width = 100, height = 80;

/// A grey picture of value `mean` with noise of the given standard deviation, which its variance channels state.
Image noisy_picture(double mean, double sigma, std::uint64_t seed) {
    Image image;
    image.width = width;
    image.height = height;
    image.channel_names = {"R", "G", "B", "variance.R", "variance.G", "variance.B"};
    for (std::uint64_t p = 0; p < width * height; ++p) {
        for (std::uint32_t c = 0; c < 3; ++c) {
            // Box and Muller.
            const RandomBlock block = random_block(seed, RandomStream::bench, p, c);
            const double u = uniform_double(block.value[0], block.value[1]), v = uniform_double(block.value[2], block.value[3]);
            const double normal = std::sqrt(-2.0 * std::log1p(-u)) * std::cos(6.283185307179586 * v);
            image.pixels.push_back(float(mean + sigma * normal));
        }
        for (int c = 0; c < 3; ++c) image.pixels.push_back(float(sigma * sigma));
    }
    return image;
}

TEST(ImageComparison, EqualPicturesDoNotDiffer) {
    const Image picture = noisy_picture(0.3, 0.01, 1);
    const ImageComparison same = compare_images(picture, picture, 0.0);
    EXPECT_EQ(same.relative_mse, 0.0);
    EXPECT_TRUE(std::isinf(same.psnr_db));
    EXPECT_EQ(same.mean_ratio[0], 1.0);
    EXPECT_EQ(same.delta_e_mean, 0.0);
    ASSERT_TRUE(same.noise_test);
    EXPECT_EQ(same.noise_test->beyond_2_sigma, 0.0);
}

/// Flat pictures have closed forms: 0.5 against 0.4.
TEST(ImageComparison, ClosedForms) {
    const ImageComparison result = compare_images(noisy_picture(0.5, 0.0, 1), noisy_picture(0.4, 0.0, 1), 0.0);
    EXPECT_NEAR(result.relative_mse, 0.01 / (0.16 + 0.01 * 0.16), 1e-6);
    for (const double ratio : result.mean_ratio) EXPECT_NEAR(ratio, 1.25, 1e-6);
    const auto encoded = [](double linear) { return 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055; };
    EXPECT_NEAR(result.psnr_db, -20.0 * std::log10(encoded(0.5) - encoded(0.4)), 1e-3);
    // Greys: dE is the difference of L* over S_L.
    const double first = 116.0 * std::cbrt(0.5) - 16.0, second = 116.0 * std::cbrt(0.4) - 16.0;
    const double middle = 0.5 * (first + second) - 50.0;
    const double expected = (first - second) / (1.0 + 0.015 * middle * middle / std::sqrt(20.0 + middle * middle));
    EXPECT_NEAR(result.delta_e_mean, expected, 2e-3);
    EXPECT_NEAR(result.delta_e_95, expected, 2e-3);
    EXPECT_FALSE(result.noise_test) << "there is no variance to test against";
    EXPECT_NEAR(result.difference.pixel(3, 4)[1], 0.1, 1e-6);
}

/// 24,000 normal deviates: 4.55 % and 0.27 % lie beyond 2 and 3, +- 4 standard errors of those counts.
TEST(ImageComparison, NoiseAloneIsRecognizedAndABiasFound) {
    const double n = 3.0 * width * height;
    const ImageComparison noise = compare_images(noisy_picture(0.3, 0.02, 1), noisy_picture(0.3, 0.01, 2), 0.0);
    ASSERT_TRUE(noise.noise_test);
    EXPECT_NEAR(noise.noise_test->beyond_2_sigma, 0.0455, 4.0 * std::sqrt(0.0455 / n));
    EXPECT_NEAR(noise.noise_test->beyond_3_sigma, 0.0027, 4.0 * std::sqrt(0.0027 / n));
    EXPECT_LT(noise.noise_test->beyond_4_sigma, 10.0 / n);
    for (const double z : noise.noise_test->mean_z) EXPECT_LT(std::abs(z), 4.0);
    // A tenth of a pixel's standard error, invisible in each: 0.1 sqrt(8000) = 8.9 standard errors of the mean.
    const ImageComparison biased = compare_images(noisy_picture(0.302236, 0.02, 1), noisy_picture(0.3, 0.01, 2), 0.0);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(biased.noise_test->mean_z[c] - noise.noise_test->mean_z[c], 0.1 * std::sqrt(double(width * height)), 0.01);
}

TEST(ImageComparison, RefusesWhatCannotBeCompared) {
    const Image good = noisy_picture(0.3, 0.01, 1);
    Image cropped = good, other = good, broken = good;
    cropped.height -= 1;
    other.channel_names = {"X", "Y", "Z", "variance.R", "variance.G", "variance.B"};
    broken.pixel(3, 2)[0] = std::nanf("");
    EXPECT_INPUT_ERROR(compare_images(good, cropped, 0.0, "a.exr", "b.exr"), "b.exr");
    EXPECT_INPUT_ERROR(compare_images(other, good, 0.0, "a.exr", "b.exr"), "a.exr: has no channels R, G, B");
    EXPECT_INPUT_ERROR(compare_images(good, broken, 0.0, "a.exr", "b.exr"), "b.exr: pixel (3, 2) is not a finite number");
}

}  // namespace
}  // namespace opal
