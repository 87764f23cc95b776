// SPDX-License-Identifier: Apache-2.0
#include "renderer/cpu/render_cpu.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>

#include "formats/command.h"

namespace opal {
namespace {

constexpr int tile_size = 16;

void add_counters(PathCounters& sum, const PathCounters& part) {
    sum.diffractions += part.diffractions;
    sum.turns_back += part.turns_back;
    sum.scatterings += part.scatterings;
    sum.grain_crossings += part.grain_crossings;
    sum.multi_beam_stays += part.multi_beam_stays;
    sum.lost_paths += part.lost_paths;
    sum.truncated_paths += part.truncated_paths;
    sum.not_a_number += part.not_a_number;
    sum.majorant_violations += part.majorant_violations;
}

struct TileSums {
    PathCounters counters;
    SpectrumTotals totals;
};

template <int N>
void render_tile(const HostScene& scene, const EmbreeScene& intersector, int tile, int first_sample, int end_sample, Film& film,
                 TileSums& sums) {
    const SceneView& view = scene.view();
    const PixelWindow& window = film.window();
    const int tiles_across = (film.width() + tile_size - 1) / tile_size;
    const int x0 = tile % tiles_across * tile_size, y0 = tile / tiles_across * tile_size;
    for (int y = y0; y < std::min(y0 + tile_size, film.height()); ++y)
        for (int x = x0; x < std::min(x0 + tile_size, film.width()); ++x)
            for (int sample = first_sample; sample < end_sample; ++sample) {
                // A path's random numbers belong to its pixel of the whole picture, so that a part of it shows the same.
                const std::uint32_t pixel =
                    std::uint32_t(window.y0 + y) * std::uint32_t(view.width) + std::uint32_t(window.x0 + x);
                PathWavelengths<N> wavelengths;
                const PathResult<N> result =
                    trace_sample(view, intersector, pixel, std::uint32_t(sample), wavelengths, sums.counters);
                film.add(view.spectra, std::uint32_t(y * film.width() + x), film_sample(wavelengths, result), sums.totals);
            }
}

using TileRenderer = decltype(&render_tile<1>);

/// The transport compiled for just as many lanes as are wanted.
TileRenderer tile_renderer(int wavelengths) {
    if (wavelengths == 1) return render_tile<1>;
    return wavelengths <= 4 ? render_tile<4> : render_tile<8>;
}

/// Samples of the next pass: few at first, so that a picture is there early, then more, to keep the film's memory traffic low; no
/// more than the time that is left allows.
int pass_size(int done, double elapsed_s, double time_limit_s) {
    const int size = done < 4 ? 1 : (done < 16 ? 4 : 16);
    if (time_limit_s <= 0.0 || done == 0) return size;
    const double affordable = (time_limit_s - elapsed_s) * done / std::max(1.0e-3, elapsed_s);
    return std::max(1, std::min(size, int(affordable)));
}

}  // namespace

RenderOutcome render_cpu(const HostScene& scene, const EmbreeScene& intersector, const RenderLimits& limits, Film& film,
                         const std::function<void(double)>& progress) {
    const SceneView& view = scene.view();
    const int tiles_across = (film.width() + tile_size - 1) / tile_size, tiles_down = (film.height() + tile_size - 1) / tile_size;
    const int num_tiles = tiles_across * tiles_down;
    std::vector<TileSums> sums(static_cast<std::size_t>(num_tiles));
    const double total_work = double(num_tiles) * limits.samples;
    std::atomic<std::int64_t> work_done = 0;
    const TileRenderer render = tile_renderer(view.wavelengths);
    const Stopwatch watch;
    RenderOutcome outcome;

    for (int done = 0; done < limits.samples && !outcome.interrupted;) {
        const int end = std::min(limits.samples, done + pass_size(done, watch.seconds(), limits.time_s));
        tbb::parallel_for(tbb::blocked_range<int>(0, num_tiles, 1), [&](const tbb::blocked_range<int>& range) {
            for (int tile = range.begin(); tile != range.end() && !interrupt_requested(); ++tile) {
                render(scene, intersector, tile, done, end, film, sums[std::size_t(tile)]);
                work_done += end - done;
                const double by_time = limits.time_s > 0.0 ? watch.seconds() / limits.time_s : 0.0;
                progress(std::min(1.0, std::max(double(work_done) / total_work, by_time)));
            }
        });
        outcome.interrupted = interrupt_requested();
        if (!outcome.interrupted) outcome.finished_samples = end;
        done = end;
        if (limits.time_s > 0.0 && watch.seconds() >= limits.time_s) break;
    }
    // In tile order: floating-point sums must not depend on which thread ended first.
    for (const TileSums& tile : sums) {
        add_counters(outcome.counters, tile.counters);
        outcome.totals.add(tile.totals);
    }
    outcome.seconds = watch.seconds();
    return outcome;
}

}  // namespace opal
