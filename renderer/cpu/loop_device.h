// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "renderer/host/bvh.h"
#include "renderer/host/path_device.h"
#include "renderer/host/scene_copy.h"

namespace opal {

/// The threads of a device as a loop on the processor: what a GPU runs, from copies of all that it reads, with the hierarchy that
/// it walks. Slower than the processor's own way with Embree; it shows that a device's way is right where there is no device.
class LoopDevice : public PathDevice {
  public:
    /// `bvh`: over the scene's meshes. `film`: of the picture that will be drawn. Throws SystemError where a device of
    /// `memory_bytes` had too little of it.
    LoopDevice(const SceneView& scene, const Bvh& bvh, const Film& film,
               std::size_t memory_bytes = std::numeric_limits<std::size_t>::max());

    std::vector<std::string> names() const override { return {name}; }
    std::optional<KernelSeconds> kernel_seconds() const override { return std::nullopt; }
    void advance(Film& film, std::span<const int> blocks, std::uint32_t samples) override;

  private:
    static constexpr const char* name = "a device's loop on the processor";

    template <int N>
    void advance_in_parts(Film& film, std::span<const int> blocks, std::uint32_t samples);
    template <int N>
    void launch(Film& film, std::span<const int> blocks, std::uint32_t samples);

    HostArrayCopier arrays_;
    SceneView scene_;
    BvhView<true> bvh_;
};

}  // namespace opal
