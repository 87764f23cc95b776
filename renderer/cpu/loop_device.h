// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/host/bvh.h"
#include "renderer/host/path_device.h"
#include "renderer/host/scene_copy.h"

namespace opal {

/// The threads of a device as a loop on the processor: what a GPU runs, from copies of all that it reads, with the hierarchy that
/// it walks. Slower than render_cpu's own way with Embree; it shows that a device's way is right where there is no device.
class LoopDevice : public PathDevice {
  public:
    /// `bvh`: over the scene's meshes.
    LoopDevice(const SceneView& scene, const Bvh& bvh);

    std::string name() const override { return "a device's loop on the processor"; }
    void advance(Film& film, std::span<const int> blocks, std::uint32_t samples) override;

  private:
    template <int N>
    void launch(Film& film, std::span<const int> blocks, std::uint32_t samples);

    HostArrayCopier arrays_;
    SceneView scene_;
    BvhView<true> bvh_;
};

}  // namespace opal
