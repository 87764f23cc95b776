// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace opal {
namespace {

FilmColors colors_for(Xyz white) {
    const Matrix3 adaptation = bradford_adaptation(white, srgb_white);
    FilmColors colors;
    for (int column = 0; column < 3; ++column) {
        const Rgb3d rgb =
            linear_srgb_from_xyz(adaptation * Xyz{column == 0 ? 1.0 : 0.0, column == 1 ? 1.0 : 0.0, column == 2 ? 1.0 : 0.0});
        colors.rgb_from_xyz[column] = rgb.r;
        colors.rgb_from_xyz[3 + column] = rgb.g;
        colors.rgb_from_xyz[6 + column] = rgb.b;
    }
    return colors;
}

/// As add_to_pixel does with the last sample of a group.
void end_group(double* sums) {
    for (int c = 0; c < 3; ++c) {
        double& group = sums[group_sum_offset + c];
        const double mean = group / noise_group;
        sums[group_square_offset + c] += mean * mean;
        group = 0.0;
    }
}

}  // namespace

double bin_centre_nm(int bin) {
    return 360.0 + 10.0 * bin;
}

void SpectrumTotals::add(const SpectrumTotals& other) {
    for (int i = 0; i < num_bins; ++i) {
        radiance[i] += other.radiance[i];
        radiance_squared[i] += other.radiance_squared[i];
        truncated[i] += other.truncated[i];
        truncated_squared[i] += other.truncated_squared[i];
    }
    for (int c = 0; c < 3; ++c) truncated_rgb[c] += other.truncated_rgb[c];
    samples += other.samples;
}

void SpectrumTotals::add(const FilmColors& colors, const SpectrumTables& tables, const FilmSample& sample) {
    for (int i = 0; i < sample.count; ++i) {
        const int bin = spectral_bin(double(sample.wavelength_nm[i]));
        bool first = true;
        for (int j = 0; j < i; ++j) first = first && spectral_bin(double(sample.wavelength_nm[j])) != bin;
        if (!first) continue;
        BinTotals sums = of_bin(bin);
        sums.add(sample, bin);
        set(bin, sums);
    }
    double lost[3];
    opal::truncated_rgb(colors, tables, sample, lost);
    for (int c = 0; c < 3; ++c) truncated_rgb[c] += lost[c];
    ++samples;
}

std::array<double, 3> opponent(const double* rgb) {
    std::array<double, 3> opponents;
    opponent_of(rgb, opponents.data());
    return opponents;
}

Film::Film(const PixelWindow& window, int full_width, int full_height, bool spectral, Xyz white, std::uint32_t first_sample)
    : window_(window),
      full_width_(full_width),
      full_height_(full_height),
      spectral_(spectral),
      colors_(colors_for(white)),
      first_sample_(first_sample),
      sums_per_pixel_(spectral ? spectrum_offset + num_bins : spectrum_offset),
      sums_(std::size_t(window.width()) * window.height() * sums_per_pixel_),
      counts_(std::size_t(window.width()) * window.height()),
      blocks_(std::size_t((window.width() + block_edge - 1) / block_edge) * ((window.height() + block_edge - 1) / block_edge)) {
    for (FilmBlock& block : blocks_) block.end_sample = first_sample;
}

PixelWindow Film::block_window(int index) const {
    const int across = (width() + block_edge - 1) / block_edge;
    const int x0 = index % across * block_edge, y0 = index / across * block_edge;
    return {x0, y0, std::min(x0 + block_edge, width()), std::min(y0 + block_edge, height())};
}

FilmSumsView Film::sums_view() {
    return {sums_.data(), counts_.data(), sums_per_pixel_, spectral_, first_sample_, colors_};
}

void Film::add(const SpectrumTables& tables, std::uint32_t pixel, const FilmSample& sample, SpectrumTotals& totals) {
    add_to_pixel(sums_view(), tables, pixel, sample);
    totals.add(colors_, tables, sample);
}

std::unique_ptr<Film> Film::make_share() const {
    auto share = std::make_unique<Film>(window_, full_width_, full_height_, spectral_);
    share->colors_ = colors_;
    return share;
}

void Film::take_share(Film& share, int index) {
    const PixelWindow pixels = block_window(index);
    for (int y = pixels.y0; y < pixels.y1; ++y)
        for (int x = pixels.x0; x < pixels.x1; ++x) {
            const auto pixel = std::uint32_t(y * width() + x);
            const std::span<double> to = sums(pixel), from = share.sums(pixel);
            for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
            std::fill(from.begin(), from.end(), 0.0);
            counts_[pixel] += share.counts_[pixel];
            share.counts_[pixel] = 0;
            if ((first_sample_ + counts_[pixel]) % noise_group == 0) end_group(to.data());
        }
    FilmBlock &block = blocks_[std::size_t(index)], &of_share = share.blocks_[std::size_t(index)];
    block.totals.add(of_share.totals);
    block.counters.add(of_share.counters);
    block.end_sample = of_share.end_sample;
    of_share.totals = {};
    of_share.counters = {};
}

std::uint64_t Film::total_samples() const {
    std::uint64_t total = 0;
    for (const std::uint32_t count : counts_) total += count;
    return total;
}

Image Film::to_image() const {
    Image image;
    image.width = window_.width();
    image.height = window_.height();
    image.x0 = window_.x0;
    image.y0 = window_.y0;
    if (window_ != PixelWindow{0, 0, full_width_, full_height_}) {
        image.full_width = full_width_;
        image.full_height = full_height_;
    }
    image.channel_names = {"R", "G", "B", "variance.R", "variance.G", "variance.B", "sample_count"};
    // Fichet et al. 2021; the radiance of each layer is the mean over its wavelengths, per nm.
    if (spectral_) image.attributes = {{"spectralLayoutVersion", "1.0"}, {"emissiveUnits", "W.m^-2.sr^-1"}};
    if (spectral_)
        for (int bin = 0; bin < num_bins; ++bin) image.channel_names.push_back(fmt::format("S0.{}nm", int(bin_centre_nm(bin))));
    image.pixels.reserve(counts_.size() * image.channel_names.size());
    for (std::size_t p = 0; p < counts_.size(); ++p) {
        const double* const sums = sums_.data() + first_sum(std::uint32_t(p));
        const double n = std::max<std::uint32_t>(1, counts_[p]);
        for (int c = 0; c < 3; ++c) image.pixels.push_back(float(sums[sum_offset + c] / n));
        for (int c = 0; c < 3; ++c) {
            const double mean = sums[sum_offset + c] / n;
            const double variance = n > 1.0 ? std::max(0.0, sums[square_offset + c] / n - mean * mean) / (n - 1.0) : 0.0;
            image.pixels.push_back(float(variance));
        }
        image.pixels.push_back(float(counts_[p]));
        if (spectral_)
            for (int bin = 0; bin < num_bins; ++bin) image.pixels.push_back(float(sums[spectrum_offset + bin] / n));
    }
    return image;
}

}  // namespace opal
