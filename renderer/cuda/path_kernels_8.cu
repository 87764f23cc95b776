// SPDX-License-Identifier: Apache-2.0
#include "renderer/cuda/path_kernels.cuh"

namespace opal {

cudaError_t launch_paths(const KernelWork<8>& work, const BvhView<false>& triangles, cudaEvent_t traced) {
    return queue_kernels(work, triangles, traced);
}

}  // namespace opal
