// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "renderer/host/bvh.h"
#include "renderer/host/path_device.h"

namespace opal {

/// The threads of a device as a loop on the processor: what a GPU runs, from copies of all that it reads, with the hierarchy that
/// it walks. Slower than render_cpu's own way with Embree; it shows that a device's way is right where there is no device.
class LoopDevice : public PathDevice {
  public:
    /// `bvh`: over the scene's meshes.
    LoopDevice(const SceneView& scene, const Bvh& bvh);
    ~LoopDevice() override;

    std::string name() const override { return "a device's loop on the processor"; }
    void advance(Film& film, std::span<const int> blocks, std::uint32_t samples) override;

  private:
    template <int N>
    void launch(Film& film, std::span<const int> blocks, std::uint32_t samples);

    class Memory;
    std::unique_ptr<Memory> memory_;
    SceneView scene_;
    BvhView<true> bvh_;
};

}  // namespace opal
