// SPDX-License-Identifier: Apache-2.0
#include "renderer/device_choice.h"

#include "formats/error.h"
#if defined(OPAL_HAS_CUDA)
#include "renderer/cuda/cuda_device.h"
#endif

namespace opal {

DeviceChoice choose_device(const std::string& asked) {
    if (asked == "cpu") return {false, "asked for"};
    // The backend has not been compared with the processor on a device yet: nobody gets it unasked.
    if (asked == "auto") return {false, "the CUDA backend is taken where it is asked for alone"};
#if defined(OPAL_HAS_CUDA)
    const CudaPresence presence = find_cuda_devices();
    if (!presence.names.empty()) return {true, "asked for"};
    const std::string reason = "no CUDA device: " + presence.reason;
#else
    const std::string reason = "this build has no CUDA backend";
#endif
    throw InputError("--device cuda: " + reason + "; allowed: auto, cpu");
}

MakeDevice device_maker(const DeviceChoice& choice, [[maybe_unused]] const std::vector<MeshData>& meshes) {
    if (!choice.cuda) return {};
#if defined(OPAL_HAS_CUDA)
    return [&meshes](const SceneView& scene, const Film& film) { return make_cuda_device(scene, Bvh(meshes), film); };
#else
    return {};
#endif
}

}  // namespace opal
