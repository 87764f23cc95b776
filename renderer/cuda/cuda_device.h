// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "renderer/host/bvh.h"
#include "renderer/host/path_device.h"

namespace opal {

/// What this machine has that runs CUDA: the names of the devices that are visible; none, with the reason, where there are none.
struct CudaPresence {
    std::vector<std::string> names;
    std::string reason;  ///< "no CUDA-capable device is detected"
};
CudaPresence find_cuda_devices();

/// The scene on all CUDA devices that are visible, of which there is one at least. `bvh`: over the scene's meshes. `film`: of the
/// picture that will be drawn. Throws SystemError where it does not fit, saying what
/// needs how much, before anything is drawn, and where a call of CUDA fails, naming it.
std::unique_ptr<PathDevice> make_cuda_device(const SceneView& scene, const Bvh& bvh, const Film& film);

}  // namespace opal
