// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <set>

#include "plane_scene.h"
#include "renderer/host/film_noise.h"

namespace opal {
namespace {

TEST(FilmNoise, LooksComeInWholeGroupsAndGrowByAQuarter) {
    std::vector<std::uint32_t> looks;
    for (std::uint32_t n = 0; looks.size() < 9; n = looks.back()) looks.push_back(next_noise_look(n));
    EXPECT_EQ(looks, (std::vector<std::uint32_t>{32, 48, 64, 80, 112, 144, 192, 240, 304}));
    // From anywhere between two looks the next one is the same.
    EXPECT_EQ(next_noise_look(65), 80u);
    EXPECT_EQ(next_noise_look(79), 80u);
}

/// The noise that one picture states, against how pictures of 24 other ranges of samples scatter: mean squares over 720 pixels.
/// Of independent samples both estimate the same: 23 degrees of freedom in each pixel give the ratio a standard error of about
/// sqrt(2 / (23 * 720)) = 1.1 % if pixels' samples were normal; they have heavy tails: 5 % allowed. Stratified samples scatter at
/// most as much as groups of them say.
TEST(FilmNoise, StatesHowMuchPicturesScatter) {
    for (const bool stratified : {false, true}) {
        const PlaneScene scene(
            {"film.spectral=false", std::string("render.sampler=\"") + (stratified ? "stratified\"" : "independent\"")});
        double stated[2] = {}, sum_of_squares[2] = {};
        constexpr std::uint32_t pictures = 24, samples = 64, pixels = 36 * 20;
        std::vector<std::array<double, 3>> sums(pixels), squares(pixels);
        for (std::uint32_t k = 0; k < pictures; ++k) {
            const auto film = scene.film(k * samples);
            scene.render(*film, int((k + 1) * samples));
            for (std::uint32_t p = 0; p < pixels; ++p) {
                const std::array<double, 3> color = opponent(film->sums(p).data());
                for (std::size_t c = 0; c < 3; ++c) {
                    sums[p][c] += color[c] / samples;
                    squares[p][c] += color[c] / samples * color[c] / samples;
                }
            }
            for (int b = 0; b < film->num_blocks(); ++b) {
                const PixelWindow window = film->block_window(b);
                const double weight = double(window.width() * window.height()) / pictures;
                const NoiseLevel noise = block_noise(*film, b);
                stated[0] += weight * noise.luminance * noise.luminance;
                stated[1] += weight * noise.chroma * noise.chroma;
            }
        }
        for (std::uint32_t p = 0; p < pixels; ++p) {
            double variance[3];
            for (std::size_t c = 0; c < 3; ++c)
                variance[c] = (squares[p][c] - sums[p][c] * sums[p][c] / pictures) / (pictures - 1);
            const double luminance = sums[p][0] / pictures;
            sum_of_squares[0] += variance[0] / (luminance * luminance);
            const double scale = std::max({luminance, std::abs(sums[p][1] / pictures), std::abs(sums[p][2] / pictures)});
            sum_of_squares[1] += 0.5 * (variance[1] + variance[2]) / (scale * scale);
        }
        for (int c = 0; c < 2; ++c) {
            const double ratio = std::sqrt(stated[c] / sum_of_squares[c]);
            std::printf("%s, %s: stated over measured noise %.3f (noise %.4f)\n", stratified ? "stratified" : "independent",
                        c == 0 ? "luminance" : "chroma", ratio, std::sqrt(stated[c] / pixels));
            if (stratified) {
                EXPECT_GT(ratio, 0.95);
                EXPECT_LT(ratio, 2.0);
            } else {
                EXPECT_NEAR(ratio, 1.0, 0.05);
            }
        }
    }
}

TEST(FilmNoise, RendersUntilQuietWithTheSameBitsFromAnyNumberOfThreads) {
    const PlaneScene scene({"render.width=64", "render.height=48"});
    const double noise = 0.07;
    constexpr int most = 240;
    const auto film = scene.film();
    scene.render(*film, most, noise);
    int settled = 0;
    std::set<std::uint32_t> counts;
    for (int b = 0; b < film->num_blocks(); ++b) {
        const FilmBlock& block = film->block(b);
        const double larger = std::max(block.luminance_noise, block.chroma_noise);
        counts.insert(block.end_sample);
        settled += block.settled ? 1 : 0;
        EXPECT_EQ(block.settled, larger <= noise) << b;
        EXPECT_TRUE(block.settled || block.end_sample == std::uint32_t(most)) << b;
        EXPECT_GE(block.end_sample, least_samples_for_noise);
    }
    EXPECT_GE(counts.size(), 4u) << "places differ in what they need";
    EXPECT_GT(settled, film->num_blocks() / 2);
    const std::optional<PictureNoise> stated = picture_noise(*film);
    ASSERT_TRUE(stated);
    EXPECT_LE(stated->median.larger(), noise);
    EXPECT_GE(stated->percentile_95.luminance, stated->median.luminance);

    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    const auto again = scene.film();
    scene.render(*again, most, noise);
    EXPECT_EQ(film->to_image().pixels, again->to_image().pixels);
}

/// Stopping where it looks quiet must not darken the picture: over 16 pictures that stop at 10 % noise, the mean differs from
/// that of fixed sample counts by less than a tenth of it, 1 %, beyond three standard errors of their own scatter.
TEST(FilmNoise, StoppingWhenQuietDoesNotDarken) {
    const PlaneScene scene({"film.spectral=false"});
    constexpr std::uint32_t most = 128, pictures = 16;
    double sum = 0.0, square = 0.0, samples = 0.0;
    for (std::uint32_t k = 0; k < pictures; ++k) {
        double mean[2];
        for (const bool adaptive : {false, true}) {
            const auto film = scene.film(k * most);
            scene.render(*film, int((k + 1) * most), adaptive ? 0.1 : 0.0);
            mean[adaptive] = 0.0;
            for (std::uint32_t p = 0; p < 720; ++p) mean[adaptive] += opponent(film->sums(p).data())[0] / film->samples(p);
            if (adaptive) samples += double(film->total_samples()) / 720.0 / pictures;
        }
        const double bias = mean[1] / mean[0] - 1.0;
        sum += bias;
        square += bias * bias;
    }
    const double bias = sum / pictures;
    const double standard_error = std::sqrt(std::max(0.0, square / pictures - bias * bias) / (pictures - 1));
    std::printf("bias of the mean %.3f %% +- %.3f %% at %.1f samples per pixel\n", 100.0 * bias, 100.0 * standard_error, samples);
    EXPECT_LT(samples, 0.8 * most) << "the test must stop somewhere";
    EXPECT_LT(std::abs(bias), 0.01 + 3.0 * standard_error);
}

TEST(FilmNoise, BlackEndsAtOnceAndFewSamplesTellNothing) {
    const PlaneScene black({"environment.radiance=0"});
    const auto film = black.film();
    EXPECT_EQ(black.render(*film, 1000, 0.01).finished_samples, int(least_samples_for_noise));
    EXPECT_EQ(film->total_samples(), 720u * least_samples_for_noise);
    const PlaneScene lit;
    const auto few = lit.film();
    lit.render(*few, 31);
    EXPECT_FALSE(picture_noise(*few));
}

}  // namespace
}  // namespace opal
