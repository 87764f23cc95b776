// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/device_room.h"

#include <fmt/format.h>

#include "formats/error.h"

namespace opal {
namespace {

/// "1.25 GB"
std::string bytes_text(std::size_t bytes) {
    return fmt::format("{:.3g} {}", double(bytes) / (bytes < 1000000000 ? 1.0e6 : 1.0e9), bytes < 1000000000 ? "MB" : "GB");
}

}  // namespace

SceneMemory device_memory(const SceneView& scene, const Bvh& bvh, const Film& film) {
    SceneMemory memory = scene_memory(scene);
    memory.items.push_back(
        {"tree of rays", bvh.nodes().size() * sizeof(BvhNode) + bvh.primitives().size() * sizeof(BvhPrimitive)});
    const std::size_t pixels = std::size_t(film.width()) * std::size_t(film.height());
    const std::size_t of_pixel = std::size_t(film.sums_per_pixel()) * sizeof(double) + sizeof(std::uint32_t);
    const std::size_t of_block = sizeof(LaunchBlock) + sizeof(LaunchTotals) + sizeof(PathCounters);
    memory.items.push_back({"film", pixels * of_pixel + std::size_t(film.num_blocks()) * of_block});
    memory.items.push_back({"paths under way", record_bytes});
    return memory;
}

void require_room(const SceneMemory& memory, std::size_t free_bytes, const std::string& device) {
    if (memory.total_bytes() <= free_bytes) return;
    std::string needs;
    for (const SceneMemory::Item& item : memory.items)
        needs += fmt::format("{}{} {}", needs.empty() ? "" : ", ", item.what, bytes_text(item.bytes));
    throw SystemError(fmt::format("the scene needs {} of the memory of {}, of which {} are free: {}",
                                  bytes_text(memory.total_bytes()), device, bytes_text(free_bytes), needs));
}

}  // namespace opal
