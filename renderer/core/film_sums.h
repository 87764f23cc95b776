// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/spectrum_view.h"

/// What a film keeps of its samples, added up alike on host and device.
namespace opal {

/// Spectral bins of 10 nm, centred at 360, 370 ... 830 nm; the two at the ends are half as wide.
inline constexpr int num_bins = 48;

/// Bin of a wavelength and the bin's width.
OPAL_HD inline int spectral_bin(double wavelength_nm) {
    return max_of(0, min_of(num_bins - 1, int((wavelength_nm - 355.0) / 10.0)));
}
OPAL_HD inline double bin_width_nm(int bin) {
    return bin == 0 || bin == num_bins - 1 ? 5.0 : 10.0;
}

/// One path's wavelengths and what it found at them.
struct FilmSample {
    const real* wavelength_nm;
    const real* pdf_per_nm;
    const real* radiance;
    const real* truncated;
    int count;  ///< lanes in use, at most max_lanes

    /// What a lane adds to its bin: radiance, or throughput thrown away, per nm.
    OPAL_HD double per_bin(const real* values, int lane) const {
        const double per_density = 1.0 / (double(pdf_per_nm[lane]) * count);
        return double(values[lane]) * per_density / bin_width_nm(spectral_bin(double(wavelength_nm[lane])));
    }
};

/// What the film keeps per pixel, in double precision, in this order; with spectral layers their num_bins sums follow. Opponent
/// colours are luminance, red-green and blue-yellow.
inline constexpr int sum_offset = 0;           ///< linear sRGB
inline constexpr int square_offset = 3;        ///< of single samples
inline constexpr int group_sum_offset = 6;     ///< opponent colour of the group of samples that is not complete
inline constexpr int group_square_offset = 9;  ///< of the means of complete groups, opponent
inline constexpr int spectrum_offset = 12;

/// Samples are stratified over a pixel: how much a pixel's mean scatters shows in groups of consecutive samples, not in single
/// ones. Group g holds the samples [16 g, 16 g + 16).
inline constexpr uint32_t noise_group = 16;

/// Luminance Y, red-green R - G and blue-yellow B - (R + G) / 2 of linear sRGB.
OPAL_HD inline void opponent_of(const double* rgb, double* opponent) {
    opponent[0] = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    opponent[1] = rgb[0] - rgb[1];
    opponent[2] = rgb[2] - 0.5 * (rgb[0] + rgb[1]);
}

/// From XYZ to the film's linear sRGB, row by row: adaptation to its white included.
struct FilmColors {
    double rgb_from_xyz[9];

    OPAL_HD void rgb(const double* xyz, double* rgb) const {
        for (int row = 0; row < 3; ++row)
            rgb[row] = rgb_from_xyz[3 * row] * xyz[0] + rgb_from_xyz[3 * row + 1] * xyz[1] + rgb_from_xyz[3 * row + 2] * xyz[2];
    }
};

/// The sums of the pixels of a film.
struct FilmSumsView {
    double* sums = nullptr;
    uint32_t* counts = nullptr;  ///< samples of each pixel
    int sums_per_pixel = 0;
    bool spectral = false;
    uint32_t first_sample = 0;  ///< of the film's
    FilmColors colors;
};

/// XYZ of a sample's radiance.
OPAL_HD inline void radiance_xyz(const SpectrumTables& tables, const FilmSample& sample, double* xyz) {
    xyz[0] = xyz[1] = xyz[2] = 0.0;
    for (int i = 0; i < sample.count; ++i) {
        const Vec3 observer = table_at(tables.observer, sample.wavelength_nm[i]);
        const double radiance = double(sample.radiance[i]) / (double(sample.pdf_per_nm[i]) * sample.count);
        xyz[0] += radiance * double(observer.x);
        xyz[1] += radiance * double(observer.y);
        xyz[2] += radiance * double(observer.z);
    }
}

/// Adds a pixel's next sample.
OPAL_HD inline void add_to_pixel(const FilmSumsView& film, const SpectrumTables& tables, uint32_t pixel,
                                 const FilmSample& sample) {
    double* const target = film.sums + size_t(pixel) * size_t(film.sums_per_pixel);
    if (film.spectral)
        for (int i = 0; i < sample.count; ++i)
            target[spectrum_offset + spectral_bin(double(sample.wavelength_nm[i]))] += sample.per_bin(sample.radiance, i);
    double xyz[3], rgb[3], opponents[3];
    radiance_xyz(tables, sample, xyz);
    film.colors.rgb(xyz, rgb);
    opponent_of(rgb, opponents);
    const bool group_ends = (film.first_sample + ++film.counts[pixel]) % noise_group == 0;
    for (int c = 0; c < 3; ++c) {
        target[sum_offset + c] += rgb[c];
        target[square_offset + c] += rgb[c] * rgb[c];
        double& group = target[group_sum_offset + c];
        group += opponents[c];
        if (!group_ends) continue;
        const double mean = group / noise_group;
        target[group_square_offset + c] += mean * mean;
        group = 0.0;
    }
}

/// Sums over many samples of one bin.
struct BinTotals {
    double radiance = 0.0;
    double radiance_squared = 0.0;   ///< of single samples
    double truncated = 0.0;          ///< throughput lost at the bounce limit
    double truncated_squared = 0.0;  ///< upper bound: of single lanes

    OPAL_HD void add(const FilmSample& sample, int bin) {
        // Lanes of one sample can share a bin: squares are of the sample's whole contribution to it.
        double whole = 0.0;
        for (int i = 0; i < sample.count; ++i) {
            if (spectral_bin(double(sample.wavelength_nm[i])) != bin) continue;
            const double in_bin = sample.per_bin(sample.radiance, i), lost = sample.per_bin(sample.truncated, i);
            whole += in_bin;
            radiance += in_bin;
            truncated += lost;
            truncated_squared += sample.count * lost * lost;
        }
        radiance_squared += whole * whole;
    }
};

/// Linear sRGB of the throughput that a sample lost, under white of radiance 1.
OPAL_HD inline void truncated_rgb(const FilmColors& colors, const SpectrumTables& tables, const FilmSample& sample, double* rgb) {
    double xyz[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < sample.count; ++i) {
        const Vec3 observer = table_at(tables.observer, sample.wavelength_nm[i]);
        const double lost = double(sample.truncated[i]) / (double(sample.pdf_per_nm[i]) * sample.count) *
                            double(table_at(tables.white, sample.wavelength_nm[i]));
        xyz[0] += lost * double(observer.x);
        xyz[1] += lost * double(observer.y);
        xyz[2] += lost * double(observer.z);
    }
    colors.rgb(xyz, rgb);
}

}  // namespace opal
