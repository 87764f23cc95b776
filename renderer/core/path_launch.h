// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/film_sums.h"
#include "renderer/core/path_tracer.h"

/// What the threads of a device do, as functions of plain indices: the same code in a kernel and in a loop on the host. First
/// every pixel's samples are traced, each by one thread; then every pixel's sums, and every bin's totals, are added up in the
/// order of the samples, each by one thread, so that the result does not depend on which thread ends first.
namespace opal {

/// A film's pixels are handled in blocks of this edge.
inline constexpr int block_edge = 8;
inline constexpr int block_pixels = block_edge * block_edge;

/// A block of the film and the first of the samples that are to be drawn.
struct LaunchBlock {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< its pixels, within the film's window
    uint32_t first_sample = 0;

    /// The place of one of the block's pixels within the film; false where the film ends before it.
    OPAL_HD bool place(int pixel_in_block, int& x, int& y) const {
        x = x0 + pixel_in_block % block_edge;
        y = y0 + pixel_in_block / block_edge;
        return x < x1 && y < y1;
    }
};

/// One path as it is handed to the film.
template <int N>
struct PathRecord {
    real wavelength_nm[N], pdf_per_nm[N], radiance[N], truncated[N];

    OPAL_HD FilmSample sample(int count) const { return {wavelength_nm, pdf_per_nm, radiance, truncated, count}; }
};

/// Sums over the pixels of a block.
struct LaunchTotals {
    BinTotals bin[num_bins];
    double truncated_rgb[3] = {};
};

/// One launch: `samples` more of every pixel of some blocks.
struct PathLaunch {
    const SceneView* scene = nullptr;
    const LaunchBlock* blocks = nullptr;
    uint32_t num_blocks = 0;
    uint32_t samples = 0;
    int film_x0 = 0, film_y0 = 0, film_width = 0;  ///< the film's window of the picture
    FilmSumsView film;

    OPAL_HD size_t num_records() const { return size_t(num_blocks) * samples * size_t(block_pixels); }
    /// Records of one sample of a block lie together.
    OPAL_HD size_t record(uint32_t block, uint32_t sample, int pixel_in_block) const {
        return (size_t(block) * samples + sample) * size_t(block_pixels) + size_t(pixel_in_block);
    }
};

/// Traces the samples [first, end) of the launch for one pixel of a block.
template <int N, class Intersector>
OPAL_HD void trace_pixel(const PathLaunch& launch, const Intersector& intersector, uint32_t block, int pixel_in_block,
                         uint32_t first, uint32_t end, PathRecord<N>* records, PathCounters& counters) {
    int x, y;
    if (!launch.blocks[block].place(pixel_in_block, x, y)) return;
    const SceneView& scene = *launch.scene;
    // A path's random numbers belong to its pixel of the whole picture, so that a part of it shows the same.
    const uint32_t pixel = uint32_t(launch.film_y0 + y) * uint32_t(scene.width) + uint32_t(launch.film_x0 + x);
    for (uint32_t sample = first; sample < end; ++sample) {
        PathWavelengths<N> wavelengths;
        const PathResult<N> result =
            trace_sample(scene, intersector, pixel, launch.blocks[block].first_sample + sample, wavelengths, counters);
        PathRecord<N>& record = records[launch.record(block, sample, pixel_in_block)];
        for (int i = 0; i < wavelengths.count; ++i) {
            record.wavelength_nm[i] = wavelengths.wavelength_nm[i];
            record.pdf_per_nm[i] = wavelengths.pdf_per_nm[i];
            record.radiance[i] = result.radiance.v[i];
            record.truncated[i] = result.truncated.v[i];
        }
    }
}

/// Adds the records of one pixel to the film.
template <int N>
OPAL_HD void add_pixel(const PathLaunch& launch, const PathRecord<N>* records, uint32_t block, int pixel_in_block) {
    int x, y;
    if (!launch.blocks[block].place(pixel_in_block, x, y)) return;
    const SceneView& scene = *launch.scene;
    for (uint32_t sample = 0; sample < launch.samples; ++sample)
        add_to_pixel(launch.film, scene.spectra, uint32_t(y * launch.film_width + x),
                     records[launch.record(block, sample, pixel_in_block)].sample(scene.wavelengths));
}

/// Calls `add` for every record of a block: sample by sample, then pixel by pixel.
template <int N, class Add>
OPAL_HD void for_each_record(const PathLaunch& launch, const PathRecord<N>* records, uint32_t block, const Add& add) {
    int x, y;
    for (uint32_t sample = 0; sample < launch.samples; ++sample)
        for (int pixel = 0; pixel < block_pixels; ++pixel)
            if (launch.blocks[block].place(pixel, x, y))
                add(records[launch.record(block, sample, pixel)].sample(launch.scene->wavelengths));
}

/// One of a block's sums: of bin `part`, or of what was truncated where `part` is num_bins.
inline constexpr int num_total_parts = num_bins + 1;
template <int N>
OPAL_HD void add_totals(const PathLaunch& launch, const PathRecord<N>* records, uint32_t block, int part, LaunchTotals& totals) {
    if (part < num_bins) {
        BinTotals sums = totals.bin[part];
        for_each_record(launch, records, block, [&](const FilmSample& sample) { sums.add(sample, part); });
        totals.bin[part] = sums;
        return;
    }
    for_each_record(launch, records, block, [&](const FilmSample& sample) {
        double lost[3];
        truncated_rgb(launch.film.colors, launch.scene->spectra, sample, lost);
        for (int c = 0; c < 3; ++c) totals.truncated_rgb[c] += lost[c];
    });
}

}  // namespace opal
