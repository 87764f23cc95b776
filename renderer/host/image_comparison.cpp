// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/image_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "formats/colorimetry.h"
#include "formats/error.h"
#include "renderer/host/finite_pixels.h"
#include "renderer/host/tone_mapping.h"

namespace opal {
namespace {

using ChannelTriple = std::array<int, 3>;

constexpr std::array<const char*, 3> rgb_names = {"R", "G", "B"};

/// Indices of prefix + R, G, B; empty where one is missing.
std::optional<ChannelTriple> find_channels(const Image& image, const std::string& prefix) {
    ChannelTriple channels;
    for (std::size_t c = 0; c < 3; ++c) {
        channels[c] = image.find_channel(prefix + rgb_names[c]);
        if (channels[c] < 0) return std::nullopt;
    }
    return channels;
}

/// The linear R, G and B alone.
Image rgb_of(const Image& image, const std::string& name) {
    const std::optional<ChannelTriple> channels = find_channels(image, "");
    if (!channels) throw InputError(fmt::format("{}: has no channels R, G, B", name));
    if (const std::optional<BrokenPixels> broken = find_broken_pixels(image)) throw InputError(describe(*broken, name));
    Image rgb;
    rgb.width = image.width;
    rgb.height = image.height;
    rgb.channel_names = {"R", "G", "B"};
    rgb.pixels.reserve(3 * std::size_t(image.width) * std::size_t(image.height));
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (const int channel : *channels) rgb.pixels.push_back(image.pixel(x, y)[channel]);
    return rgb;
}

std::array<double, 3> channel_means(const Image& rgb) {
    std::array<double, 3> mean = {};
    for (std::size_t i = 0; i < rgb.pixels.size(); ++i) mean[i % 3] += double(rgb.pixels[i]);
    for (double& value : mean) value /= double(rgb.pixels.size() / 3);
    return mean;
}

double relative_mse(const Image& picture, const Image& reference) {
    const std::array<double, 3> mean = channel_means(reference);
    const double floor = 0.1 * (mean[0] + mean[1] + mean[2]) / 3.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const double b = double(reference.pixels[i]), difference = double(picture.pixels[i]) - b;
        if (difference != 0.0) sum += difference * difference / (b * b + floor * floor);
    }
    return sum / double(picture.pixels.size());
}

double psnr_db(const Image& shown, const Image& shown_reference) {
    double squares = 0.0;
    for (std::size_t i = 0; i < shown.pixels.size(); ++i) {
        const double difference = double(shown.pixels[i]) - double(shown_reference.pixels[i]);
        squares += difference * difference;
    }
    if (squares == 0.0) return std::numeric_limits<double>::infinity();
    return -10.0 * std::log10(squares / double(shown.pixels.size()));
}

Lab lab_of_shown(const float* srgb) {
    return lab_from_xyz(
        xyz_from_linear_srgb({srgb_decoded(double(srgb[0])), srgb_decoded(double(srgb[1])), srgb_decoded(double(srgb[2]))}),
        srgb_white);
}

std::vector<float> color_differences(const Image& shown, const Image& shown_reference) {
    std::vector<float> differences(shown.pixels.size() / 3);
    for (std::size_t p = 0; p < differences.size(); ++p)
        differences[p] =
            float(delta_e_2000(lab_of_shown(shown.pixels.data() + 3 * p), lab_of_shown(shown_reference.pixels.data() + 3 * p)));
    return differences;
}

std::optional<NoiseTest> noise_test(const Image& picture, const Image& reference, const Image& rgb, const Image& reference_rgb) {
    const std::optional<ChannelTriple> variance = find_channels(picture, "variance.");
    const std::optional<ChannelTriple> reference_variance = find_channels(reference, "variance.");
    if (!variance || !reference_variance) return std::nullopt;
    NoiseTest test;
    double sum[3] = {}, variance_sum[3] = {};
    std::size_t tested = 0;
    std::array<std::size_t, 3> beyond = {};
    for (std::size_t p = 0; p < rgb.pixels.size() / 3; ++p) {
        const int x = int(p % std::size_t(rgb.width)), y = int(p / std::size_t(rgb.width));
        for (std::size_t c = 0; c < 3; ++c) {
            const double both =
                double(picture.pixel(x, y)[(*variance)[c]]) + double(reference.pixel(x, y)[(*reference_variance)[c]]);
            const double difference = double(rgb.pixels[3 * p + c]) - double(reference_rgb.pixels[3 * p + c]);
            sum[c] += difference;
            variance_sum[c] += both;
            if (!(both > 0.0)) continue;
            ++tested;
            for (std::size_t s = 0; s < 3; ++s)
                if (std::abs(difference) > double(s + 2) * std::sqrt(both)) ++beyond[s];
        }
    }
    if (tested == 0) return std::nullopt;
    test.beyond_2_sigma = double(beyond[0]) / double(tested);
    test.beyond_3_sigma = double(beyond[1]) / double(tested);
    test.beyond_4_sigma = double(beyond[2]) / double(tested);
    for (int c = 0; c < 3; ++c) test.mean_z[c] = variance_sum[c] > 0.0 ? sum[c] / std::sqrt(variance_sum[c]) : 0.0;
    return test;
}

}  // namespace

ImageComparison compare_images(const Image& picture, const Image& reference, double exposure_ev, const std::string& picture_name,
                               const std::string& reference_name) {
    if (picture.width != reference.width || picture.height != reference.height)
        throw InputError(fmt::format("{} has {}x{} pixels, {} {}x{}; only pictures of one size can be compared", picture_name,
                                     picture.width, picture.height, reference_name, reference.width, reference.height));
    const Image rgb = rgb_of(picture, picture_name), reference_rgb = rgb_of(reference, reference_name);
    ImageComparison result;
    result.relative_mse = relative_mse(rgb, reference_rgb);
    const std::array<double, 3> mean = channel_means(rgb), reference_mean = channel_means(reference_rgb);
    for (std::size_t c = 0; c < 3; ++c) result.mean_ratio[c] = mean[c] / reference_mean[c];
    const Image shown = tone_mapped(rgb, exposure_ev), shown_reference = tone_mapped(reference_rgb, exposure_ev);
    result.psnr_db = psnr_db(shown, shown_reference);
    std::vector<float> differences = color_differences(shown, shown_reference);

    result.difference.width = rgb.width;
    result.difference.height = rgb.height;
    result.difference.channel_names = {"R", "G", "B", "delta_e"};
    for (std::size_t p = 0; p < differences.size(); ++p) {
        for (std::size_t c = 0; c < 3; ++c)
            result.difference.pixels.push_back(rgb.pixels[3 * p + c] - reference_rgb.pixels[3 * p + c]);
        result.difference.pixels.push_back(differences[p]);
        result.delta_e_mean += double(differences[p]) / double(differences.size());
    }
    const auto percentile = differences.begin() + std::ptrdiff_t((differences.size() - 1) * 95 / 100);
    std::nth_element(differences.begin(), percentile, differences.end());
    result.delta_e_95 = double(*percentile);
    result.noise_test = noise_test(picture, reference, rgb, reference_rgb);
    return result;
}

}  // namespace opal
