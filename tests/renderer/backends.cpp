// SPDX-License-Identifier: Apache-2.0
#include "backends.h"

#include <stdexcept>

#include "renderer/cpu/loop_device.h"
#if defined(OPAL_HAS_CUDA)
#include "renderer/cuda/cuda_device.h"
#endif

namespace opal {

std::string missing_backend(const std::string& backend) {
    if (backend != "cuda") return "";
#if defined(OPAL_HAS_CUDA)
    const CudaPresence presence = find_cuda_devices();
    return presence.names.empty() ? "no CUDA device: " + presence.reason : "";
#else
    return "this build has no CUDA backend";
#endif
}

MakeDevice backend_maker(const std::string& backend, const std::vector<MeshData>& meshes) {
    if (backend == "cpu") return {};
    if (backend == "loop")
        return [&meshes](const SceneView& scene, const Film& film) {
            return std::make_unique<LoopDevice>(scene, Bvh(meshes), film);
        };
#if defined(OPAL_HAS_CUDA)
    if (backend == "cuda")
        return [&meshes](const SceneView& scene, const Film& film) { return make_cuda_device(scene, Bvh(meshes), film); };
#endif
    throw std::logic_error("no backend " + backend);
}

}  // namespace opal
