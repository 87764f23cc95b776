// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace opal {

int spectral_bin(double wavelength_nm) {
    return std::clamp(int((wavelength_nm - 355.0) / 10.0), 0, num_bins - 1);
}

double bin_width_nm(int bin) {
    return bin == 0 || bin == num_bins - 1 ? 5.0 : 10.0;
}

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

std::array<double, 3> opponent(const double* rgb) {
    return {0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2], rgb[0] - rgb[1], rgb[2] - 0.5 * (rgb[0] + rgb[1])};
}

Film::Film(const PixelWindow& window, int full_width, int full_height, bool spectral, Xyz white, std::uint32_t first_sample)
    : window_(window),
      full_width_(full_width),
      full_height_(full_height),
      spectral_(spectral),
      adaptation_(bradford_adaptation(white, srgb_white)),
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

void Film::add(const SpectrumTables& tables, std::uint32_t pixel, const FilmSample& sample, SpectrumTotals& totals) {
    double x = 0.0, y = 0.0, z = 0.0;
    double lost_x = 0.0, lost_y = 0.0, lost_z = 0.0;
    std::array<double, max_lanes> in_bin = {};
    std::array<int, max_lanes> bins = {};
    for (int i = 0; i < sample.count; ++i) {
        const Vec3 observer = table_at(tables.observer, sample.wavelength_nm[i]);
        const double per_density = 1.0 / (double(sample.pdf_per_nm[i]) * sample.count);
        const double radiance = double(sample.radiance[i]) * per_density;
        x += radiance * double(observer.x);
        y += radiance * double(observer.y);
        z += radiance * double(observer.z);
        bins[i] = spectral_bin(double(sample.wavelength_nm[i]));
        in_bin[i] = radiance / bin_width_nm(bins[i]);
        totals.radiance[bins[i]] += in_bin[i];
        const double truncated = double(sample.truncated[i]) * per_density;
        totals.truncated[bins[i]] += truncated / bin_width_nm(bins[i]);
        totals.truncated_squared[bins[i]] +=
            sample.count * truncated * truncated / (bin_width_nm(bins[i]) * bin_width_nm(bins[i]));
        const double lost = truncated * double(table_at(tables.white, sample.wavelength_nm[i]));
        lost_x += lost * double(observer.x);
        lost_y += lost * double(observer.y);
        lost_z += lost * double(observer.z);
        if (spectral_) sums_[first_sum(pixel) + spectrum_offset + bins[i]] += in_bin[i];
    }
    // Lanes of one sample can share a bin: squares are of the sample's whole contribution to it.
    for (int i = 0; i < sample.count; ++i) {
        double whole = 0.0;
        bool first = true;
        for (int j = 0; j < sample.count; ++j) {
            if (bins[j] != bins[i]) continue;
            if (j < i) first = false;
            whole += in_bin[j];
        }
        if (first) totals.radiance_squared[bins[i]] += whole * whole;
    }
    ++totals.samples;
    const Rgb3d lost_rgb = rgb_of({lost_x, lost_y, lost_z});
    totals.truncated_rgb[0] += lost_rgb.r;
    totals.truncated_rgb[1] += lost_rgb.g;
    totals.truncated_rgb[2] += lost_rgb.b;

    const Rgb3d rgb = rgb_of({x, y, z});
    const double values[3] = {rgb.r, rgb.g, rgb.b};
    const std::array<double, 3> opponents = opponent(values);
    double* const target = sums_.data() + first_sum(pixel);
    const bool group_ends = (first_sample_ + ++counts_[pixel]) % noise_group == 0;
    for (int c = 0; c < 3; ++c) {
        target[sum_offset + c] += values[c];
        target[square_offset + c] += values[c] * values[c];
        double& group = target[group_sum_offset + c];
        group += opponents[c];
        if (!group_ends) continue;
        const double mean = group / noise_group;
        target[group_square_offset + c] += mean * mean;
        group = 0.0;
    }
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
