// SPDX-License-Identifier: Apache-2.0
#include "renderer/cpu/render_cpu.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>

#include "formats/command.h"
#include "renderer/cpu/light_guides.h"

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
void render_tile(const SceneView& view, const EmbreeScene& intersector, int tile, int first_sample, int end_sample, Film& film,
                 TileSums& sums) {
    const int tiles_across = (view.width + tile_size - 1) / tile_size;
    const int x0 = tile % tiles_across * tile_size, y0 = tile / tiles_across * tile_size;
    for (int y = y0; y < std::min(y0 + tile_size, view.height); ++y)
        for (int x = x0; x < std::min(x0 + tile_size, view.width); ++x)
            for (int sample = first_sample; sample < end_sample; ++sample) {
                const std::uint32_t pixel = std::uint32_t(y) * std::uint32_t(view.width) + std::uint32_t(x);
                PathWavelengths<N> wavelengths;
                const PathResult<N> result =
                    trace_sample(view, intersector, pixel, std::uint32_t(sample), wavelengths, sums.counters);
                film.add(view.spectra, pixel, film_sample(wavelengths, result), sums.totals);
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
    const Stopwatch watch;
    const LightGuides guides(scene, intersector);
    const SceneView& view = guides.scene();
    const int tiles_across = (view.width + tile_size - 1) / tile_size, tiles_down = (view.height + tile_size - 1) / tile_size;
    const int num_tiles = tiles_across * tiles_down;
    std::vector<TileSums> sums(static_cast<std::size_t>(num_tiles));
    const double total_work = double(num_tiles) * limits.samples;
    std::atomic<std::int64_t> work_done = 0;
    const TileRenderer render = tile_renderer(view.wavelengths);
    RenderOutcome outcome;

    for (int done = 0; done < limits.samples && !outcome.interrupted;) {
        const int end = std::min(limits.samples, done + pass_size(done, watch.seconds(), limits.time_s));
        tbb::parallel_for(tbb::blocked_range<int>(0, num_tiles, 1), [&](const tbb::blocked_range<int>& range) {
            for (int tile = range.begin(); tile != range.end() && !interrupt_requested(); ++tile) {
                render(view, intersector, tile, done, end, film, sums[std::size_t(tile)]);
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

void add_aovs(const HostScene& scene, const EmbreeScene& intersector, const std::vector<std::string>& aovs, Image& image) {
    if (aovs.empty()) return;
    const SceneView& view = scene.view();
    const std::size_t old_channels = image.channel_names.size();
    for (const std::string& aov : aovs) {
        if (aov == "normal")
            for (const char* axis : {"normal.X", "normal.Y", "normal.Z"}) image.channel_names.push_back(axis);
        else
            image.channel_names.push_back(aov);
    }
    const std::size_t channels = image.channel_names.size();
    std::vector<float> pixels(std::size_t(image.width) * image.height * channels);
    tbb::parallel_for(0, image.height, [&](int y) {
        for (int x = 0; x < image.width; ++x) {
            const std::size_t pixel = std::size_t(y) * image.width + x;
            float* target = pixels.data() + pixel * channels;
            std::copy_n(image.pixels.data() + pixel * old_channels, old_channels, target);
            target += old_channels;
            const Ray ray = camera_ray(view.camera, (float(x) + 0.5f) / float(view.width), (float(y) + 0.5f) / float(view.height),
                                       0.0f, 0.0f);
            RayHit hit;
            const bool found = intersector.closest(ray, hit);
            const Surface surface = found ? surface_at(view, hit) : Surface{};
            for (const std::string& aov : aovs) {
                if (aov == "object_id") *target++ = found ? float(hit.mesh) : -1.0f;
                if (aov == "depth") *target++ = found ? hit.distance_mm : 0.0f;
                if (aov == "grain_id") {
                    float grain = 0.0f;
                    if (found && surface.body >= 0 && view.bodies[surface.body].diffraction != Diffraction::none) {
                        const OpalView& opal = view.bodies[surface.body];
                        const RigidTransform& transform = opal.world_from_object;
                        GrainWalk walk(opal.grains, transform.local_from_world_point(surface.position),
                                       transform.local_from_world_direction(-surface.geometric_normal));
                        float distance = 0.0f;
                        grain = float(walk.next_grain(0, distance, 3.0f / opal.grains.voxels_per_mm));
                    }
                    *target++ = grain;
                }
                if (aov == "normal")
                    for (const float component : {surface.shading_normal.x, surface.shading_normal.y, surface.shading_normal.z})
                        *target++ = found ? component : 0.0f;
            }
        }
    });
    image.pixels = std::move(pixels);
}

}  // namespace opal
