// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/film_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace opal {
namespace {

/// The share of a picture's brightness below which noise need not get smaller with the pixel.
constexpr double floor_share = 0.05;

/// An error that counts nothing where there is none, whatever it is divided by.
double relative_square(double variance, double scale) {
    if (variance <= 0.0) return 0.0;
    return scale > 0.0 ? variance / (scale * scale) : std::numeric_limits<double>::infinity();
}

double percentile(std::vector<double>& values, double share) {
    const auto place = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

}  // namespace

std::uint32_t next_noise_look(std::uint32_t samples) {
    std::uint32_t look = least_samples_for_noise;
    while (look <= samples) look += noise_group * ((look + 4 * noise_group - 1) / (4 * noise_group));
    return look;
}

double measured_noise_floor(const Film& film) {
    const std::uint32_t pixels = std::uint32_t(film.width()) * std::uint32_t(film.height());
    double sum = 0.0;
    for (std::uint32_t p = 0; p < pixels; ++p)
        sum += std::sqrt(std::max(0.0, opponent(film.sums(p).data() + sum_offset)[0]) / std::max(1u, film.samples(p)));
    const double mean = sum / pixels;
    return floor_share * mean * mean;
}

NoiseLevel block_noise(const Film& film, int block) {
    const PixelWindow window = film.block_window(block);
    double luminance = 0.0, chroma = 0.0;
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x) {
            const std::uint32_t pixel = std::uint32_t(y * film.width() + x);
            const double* const sums = film.sums(pixel).data();
            const double groups = double(film.samples(pixel) / noise_group);
            const std::array<double, 3> total = opponent(sums + sum_offset);
            double mean[3], variance[3];
            for (std::size_t c = 0; c < 3; ++c) {
                mean[c] = total[c] / double(film.samples(pixel));
                variance[c] = std::max(0.0, sums[group_square_offset + int(c)] / groups - mean[c] * mean[c]) / (groups - 1.0);
            }
            const double scale = std::max(mean[0], film.noise_floor());
            luminance += relative_square(variance[0], scale);
            const double chroma_scale = std::max({scale, std::abs(mean[1]), std::abs(mean[2])});
            chroma += relative_square(0.5 * (variance[1] + variance[2]), chroma_scale);
        }
    const double pixels = double(window.width()) * double(window.height());
    return {std::sqrt(luminance / pixels), std::sqrt(chroma / pixels)};
}

std::optional<PictureNoise> picture_noise(const Film& film) {
    std::vector<double> luminance, chroma;
    for (int b = 0; b < film.num_blocks(); ++b) {
        luminance.push_back(double(film.block(b).luminance_noise.load(std::memory_order_relaxed)));
        chroma.push_back(double(film.block(b).chroma_noise.load(std::memory_order_relaxed)));
        if (luminance.back() < 0.0 || chroma.back() < 0.0) return std::nullopt;
    }
    PictureNoise noise;
    noise.median = {percentile(luminance, 0.5), percentile(chroma, 0.5)};
    noise.percentile_95 = {percentile(luminance, 0.95), percentile(chroma, 0.95)};
    return noise;
}

}  // namespace opal
