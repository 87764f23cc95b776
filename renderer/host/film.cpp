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

Film::Film(const PixelWindow& window, int full_width, int full_height, bool spectral, Xyz white)
    : window_(window),
      full_width_(full_width),
      full_height_(full_height),
      spectral_(spectral),
      adaptation_(bradford_adaptation(white, srgb_white)),
      pixels_(std::size_t(window.width()) * window.height()) {
    if (spectral) spectra_.assign(pixels_.size() * num_bins, 0.0f);
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
        if (spectral_) spectra_[std::size_t(pixel) * num_bins + bins[i]] += float(in_bin[i]);
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
    Pixel& target = pixels_[pixel];
    const double values[3] = {rgb.r, rgb.g, rgb.b};
    for (int c = 0; c < 3; ++c) {
        target.sum[c] += values[c];
        target.square[c] += values[c] * values[c];
    }
    ++target.samples;
}

std::uint64_t Film::total_samples() const {
    std::uint64_t total = 0;
    for (const Pixel& pixel : pixels_) total += pixel.samples;
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
    image.pixels.reserve(pixels_.size() * image.channel_names.size());
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
        const Pixel& pixel = pixels_[p];
        const double n = std::max<std::uint32_t>(1, pixel.samples);
        for (const double sum : pixel.sum) image.pixels.push_back(float(sum / n));
        for (int c = 0; c < 3; ++c) {
            const double mean = pixel.sum[c] / n;
            const double variance = n > 1.0 ? std::max(0.0, pixel.square[c] / n - mean * mean) / (n - 1.0) : 0.0;
            image.pixels.push_back(float(variance));
        }
        image.pixels.push_back(float(pixel.samples));
        if (spectral_)
            for (int bin = 0; bin < num_bins; ++bin) image.pixels.push_back(spectra_[p * num_bins + bin] / float(n));
    }
    return image;
}

}  // namespace opal
