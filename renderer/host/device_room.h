// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "renderer/host/bvh.h"
#include "renderer/host/film.h"
#include "renderer/host/scene_copy.h"

namespace opal {

/// Records of paths that a device keeps at most, in bytes.
inline constexpr std::size_t record_bytes = std::size_t(1) << 30;

/// What drawing takes of a device's memory: the scene, the hierarchy of its rays, the film and the paths under way.
SceneMemory device_memory(const SceneView& scene, const Bvh& bvh, const Film& film);

/// Throws SystemError, saying what needs how much, where that is more than `free_bytes`. `device`: its name.
void require_room(const SceneMemory& memory, std::size_t free_bytes, const std::string& device);

/// How many blocks' records a device has room for at once; at least one.
template <int N>
std::size_t blocks_at_once(std::uint32_t samples) {
    return std::max<std::size_t>(1, record_bytes / (std::size_t(block_pixels) * samples * sizeof(PathRecord<N>)));
}

}  // namespace opal
