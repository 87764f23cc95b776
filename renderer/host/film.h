// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "formats/colorimetry.h"
#include "formats/image.h"
#include "formats/scene.h"
#include "renderer/core/path_launch.h"

namespace opal {

/// Sums over the whole picture, per bin: for the report and for checking energy without storing spectra per pixel.
struct SpectrumTotals {
    std::array<double, num_bins> radiance = {};
    std::array<double, num_bins> radiance_squared = {};   ///< of single samples
    std::array<double, num_bins> truncated = {};          ///< throughput lost at the bounce limit
    std::array<double, num_bins> truncated_squared = {};  ///< upper bound: of single lanes
    std::array<double, 3> truncated_rgb = {};             ///< the same in linear sRGB under white of radiance 1
    std::uint64_t samples = 0;

    void add(const SpectrumTotals& other);
    void add(const FilmColors& colors, const SpectrumTables& tables, const FilmSample& sample);
    BinTotals of_bin(int bin) const { return {radiance[bin], radiance_squared[bin], truncated[bin], truncated_squared[bin]}; }
    void set(int bin, const BinTotals& sums) {
        radiance[bin] = sums.radiance;
        radiance_squared[bin] = sums.radiance_squared;
        truncated[bin] = sums.truncated;
        truncated_squared[bin] = sums.truncated_squared;
    }
};

template <int N>
FilmSample film_sample(const PathWavelengths<N>& wavelengths, const PathResult<N>& result) {
    return {wavelengths.wavelength_nm, wavelengths.pdf_per_nm, result.radiance.v, result.truncated.v, wavelengths.count};
}

/// Luminance Y, red-green R - G and blue-yellow B - (R + G) / 2 of linear sRGB.
std::array<double, 3> opponent(const double* rgb);

/// A block's pixels are rendered together, so that a render can be kept, ended and continued block by block: how far a block has
/// come. Whoever renders or reads the block's pixels holds the lock.
struct FilmBlock {
    mutable std::mutex lock;
    std::uint32_t end_sample = 0;  ///< its samples from the film's first up to here are in
    bool settled = false;          ///< quiet enough: no more samples wanted
    /// Noise when last looked at, see film_noise.h; below 0: not known. Read without the lock.
    std::atomic<float> luminance_noise = -1.0f, chroma_noise = -1.0f;
    PathCounters counters;
    SpectrumTotals totals;
};

/// Accumulates samples per pixel and remembers how far each block of pixels has come: the exact state of a render, which can be
/// stored and continued with the same result to the bit.
class Film {
  public:
    /// For the part `window` of a picture of full_width x full_height pixels. RGB is adapted so that light of the chromaticity
    /// `white`, XYZ with Y = 1, is neutral (Bradford); spectra are not. Samples come in order from `first_sample` on.
    Film(const PixelWindow& window, int full_width, int full_height, bool spectral, Xyz white = srgb_white,
         std::uint32_t first_sample = 0);
    /// For a whole picture.
    Film(int width, int height, bool spectral, Xyz white = srgb_white)
        : Film({0, 0, width, height}, width, height, spectral, white) {}

    /// Adds one path's result, the pixel's next sample, to a pixel (counted row by row within the window) and to `totals`. Pixels
    /// may be filled from different threads, each from one at a time.
    void add(const SpectrumTables& tables, std::uint32_t pixel, const FilmSample& sample, SpectrumTotals& totals);
    /// Where its pixels' sums lie, as what adds to them from elsewhere needs it.
    FilmSumsView sums_view();

    const PixelWindow& window() const { return window_; }
    int width() const { return window_.width(); }
    int height() const { return window_.height(); }
    bool spectral() const { return spectral_; }
    std::uint32_t first_sample() const { return first_sample_; }
    std::uint32_t samples(std::uint32_t pixel) const { return counts_[pixel]; }
    std::uint64_t total_samples() const;

    int num_blocks() const { return int(blocks_.size()); }
    FilmBlock& block(int index) { return blocks_[std::size_t(index)]; }
    const FilmBlock& block(int index) const { return blocks_[std::size_t(index)]; }
    /// Pixels of a block, within the film's window.
    PixelWindow block_window(int index) const;

    int sums_per_pixel() const { return sums_per_pixel_; }
    std::span<const double> sums(std::uint32_t pixel) const {
        return {sums_.data() + first_sum(pixel), std::size_t(sums_per_pixel_)};
    }
    std::span<double> sums(std::uint32_t pixel) { return {sums_.data() + first_sum(pixel), std::size_t(sums_per_pixel_)}; }
    void set_samples(std::uint32_t pixel, std::uint32_t count) { counts_[pixel] = count; }

    /// A film for shares of this one's samples: nothing in it, spectra and colours alike.
    std::unique_ptr<Film> make_share() const;
    /// Adds what `share`, made by make_share, holds of a block: its next samples, fewer than noise_group and all of one group.
    /// Clears them there. The caller holds the block's lock.
    void take_share(Film& share, int block);

    /// Luminance below which noise is no longer relative to a pixel's own; below 0: not known yet.
    double noise_floor() const { return noise_floor_; }
    void set_noise_floor(double floor) { noise_floor_ = floor; }

    /// The film's window of the picture. Channels R, G, B (means), variance.R, variance.G, variance.B (of the means),
    /// sample_count, and S0.<nm>nm where spectral.
    Image to_image() const;

  private:
    std::size_t first_sum(std::uint32_t pixel) const { return std::size_t(pixel) * std::size_t(sums_per_pixel_); }

    PixelWindow window_;
    int full_width_, full_height_;
    bool spectral_;
    FilmColors colors_;
    std::uint32_t first_sample_;
    int sums_per_pixel_;
    std::vector<double> sums_;
    std::vector<std::uint32_t> counts_;
    std::vector<FilmBlock> blocks_;
    std::atomic<double> noise_floor_ = -1.0;
};

double bin_centre_nm(int bin);

}  // namespace opal
