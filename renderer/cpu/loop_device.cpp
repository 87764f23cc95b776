// SPDX-License-Identifier: Apache-2.0
#include "renderer/cpu/loop_device.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "renderer/host/device_room.h"

namespace opal {

LoopDevice::LoopDevice(const SceneView& scene, const Bvh& bvh, const Film& film, std::size_t memory_bytes) {
    require_room(device_memory(scene, bvh, film), memory_bytes, name);
    scene_ = copied_scene(scene, arrays_);
    const BvhNode* nodes = arrays_.copy(bvh.nodes().data(), bvh.nodes().size(), "rays");
    const BvhPrimitive* primitives = arrays_.copy(bvh.primitives().data(), bvh.primitives().size(), "rays");
    bvh_ = {bvh.root(), bvh.reach_mm(), nodes, primitives, std::uint32_t(bvh.primitives().size()), scene_.meshes};
}

void LoopDevice::advance(Film& film, std::span<const int> blocks, std::uint32_t samples) {
    if (scene_.wavelengths == 1) return advance_in_parts<1>(film, blocks, samples);
    return scene_.wavelengths <= 4 ? advance_in_parts<4>(film, blocks, samples) : advance_in_parts<8>(film, blocks, samples);
}

template <int N>
void LoopDevice::advance_in_parts(Film& film, std::span<const int> blocks, std::uint32_t samples) {
    const std::size_t at_once = blocks_at_once<N>(samples);
    for (std::size_t first = 0; first < blocks.size(); first += at_once)
        launch<N>(film, blocks.subspan(first, std::min(at_once, blocks.size() - first)), samples);
}

template <int N>
void LoopDevice::launch(Film& film, std::span<const int> blocks, std::uint32_t samples) {
    const std::vector<LaunchBlock> places = launch_blocks(film, blocks);
    std::vector<LaunchTotals> totals = launch_totals(film, blocks);
    const PathLaunch launch{&scene_,      places.data(),    std::uint32_t(places.size()),
                            samples,      film.window().x0, film.window().y0,
                            film.width(), film.sums_view()};
    std::vector<PathRecord<N>> records(launch.num_records());
    tbb::parallel_for(0u, launch.num_blocks, [&](std::uint32_t block) {
        PathCounters counters;
        for (int pixel = 0; pixel < block_pixels; ++pixel)
            trace_pixel(launch, bvh_, block, pixel, 0, samples, records.data(), counters);
        FilmBlock& target = film.block(blocks[block]);
        const std::scoped_lock lock(target.lock);
        for (int pixel = 0; pixel < block_pixels; ++pixel) add_pixel(launch, records.data(), block, pixel);
        for (int part = 0; part < num_total_parts; ++part) add_totals(launch, records.data(), block, part, totals[block]);
        const int pixels = (places[block].x1 - places[block].x0) * (places[block].y1 - places[block].y0);
        finish_block(target, samples, pixels, totals[block], counters);
    });
}

}  // namespace opal
