// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "renderer/host/bvh.h"
#include "renderer/host/path_device.h"

namespace opal {

/// What this machine has that runs CUDA: the first device's name; empty, with the reason, where there is none.
struct CudaPresence {
    std::string name;
    std::string reason;  ///< "no CUDA-capable device is detected"
};
CudaPresence find_cuda_device();

/// The scene on the first CUDA device. `bvh`: over the scene's meshes. Throws SystemError where it does not fit, saying what
/// needs how much, before anything is drawn, and where a call of CUDA fails, naming it.
std::unique_ptr<PathDevice> make_cuda_device(const SceneView& scene, const Bvh& bvh);

}  // namespace opal
