// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "formats/colorimetry.h"
#include "formats/image.h"
#include "formats/scene.h"
#include "renderer/core/path_tracer.h"

namespace opal {

/// Spectral bins of 10 nm, centred at 360, 370 ... 830 nm; the two at the ends are half as wide.
inline constexpr int num_bins = 48;

/// Sums over the whole picture, per bin: for the report and for checking energy without storing spectra per pixel.
struct SpectrumTotals {
    std::array<double, num_bins> radiance = {};
    std::array<double, num_bins> radiance_squared = {};   ///< of single samples
    std::array<double, num_bins> truncated = {};          ///< throughput lost at the bounce limit
    std::array<double, num_bins> truncated_squared = {};  ///< upper bound: of single lanes
    std::array<double, 3> truncated_rgb = {};             ///< the same in linear sRGB under white of radiance 1
    std::uint64_t samples = 0;

    void add(const SpectrumTotals& other);
};

/// One path's wavelengths and what it found at them.
struct FilmSample {
    const float* wavelength_nm;
    const float* pdf_per_nm;
    const float* radiance;
    const float* truncated;
    int count;  ///< lanes in use, at most max_lanes
};

template <int N>
FilmSample film_sample(const PathWavelengths<N>& wavelengths, const PathResult<N>& result) {
    return {wavelengths.wavelength_nm, wavelengths.pdf_per_nm, result.radiance.v, result.truncated.v, wavelengths.count};
}

/// Accumulates samples per pixel: linear sRGB sums in double precision, sums of squares for the variance, counts, optional
/// spectra.
class Film {
  public:
    /// For the part `window` of a picture of full_width x full_height pixels. RGB is adapted so that light of the chromaticity
    /// `white`, XYZ with Y = 1, is neutral (Bradford); spectra are not.
    Film(const PixelWindow& window, int full_width, int full_height, bool spectral, Xyz white = srgb_white);
    /// For a whole picture.
    Film(int width, int height, bool spectral, Xyz white = srgb_white)
        : Film({0, 0, width, height}, width, height, spectral, white) {}

    /// Adds one path's result to a pixel (counted row by row within the window) and to `totals`. Pixels may be filled from
    /// different threads, each from one at a time.
    void add(const SpectrumTables& tables, std::uint32_t pixel, const FilmSample& sample, SpectrumTotals& totals);

    const PixelWindow& window() const { return window_; }
    int width() const { return window_.width(); }
    int height() const { return window_.height(); }
    std::uint32_t samples(std::uint32_t pixel) const { return pixels_[pixel].samples; }
    std::uint64_t total_samples() const;

    /// The film's window of the picture. Channels R, G, B (means), variance.R, variance.G, variance.B (of the means),
    /// sample_count, and S0.<nm>nm where spectral.
    Image to_image() const;

  private:
    struct Pixel {
        double sum[3] = {};
        double square[3] = {};
        std::uint32_t samples = 0;
    };

    Rgb3d rgb_of(Xyz color) const { return linear_srgb_from_xyz(adaptation_ * color); }

    PixelWindow window_;
    int full_width_, full_height_;
    bool spectral_;
    Matrix3 adaptation_;
    std::vector<Pixel> pixels_;
    std::vector<float> spectra_;
};

/// Bin of a wavelength and the bin's width.
int spectral_bin(double wavelength_nm);
double bin_width_nm(int bin);
double bin_centre_nm(int bin);

}  // namespace opal
