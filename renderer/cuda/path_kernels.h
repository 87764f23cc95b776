// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime.h>

#include "renderer/core/bvh_view.h"
#include "renderer/core/path_launch.h"

/// Kernels, compiled in files of their own: each takes a minute or more for every kind of device.
namespace opal {

/// What a launch works on; all of it on the device. `launch` itself is passed by value.
template <int N>
struct KernelWork {
    PathLaunch launch;
    PathRecord<N>* records = nullptr;
    LaunchTotals* totals = nullptr;    ///< of each block
    PathCounters* counters = nullptr;  ///< of each block, added to
};

/// Queues tracing, the event, and adding up, on the current device. Fewer wavelengths than lanes may be in use.
cudaError_t launch_paths(const KernelWork<4>& work, const BvhView<false>& triangles, cudaEvent_t traced);
cudaError_t launch_paths(const KernelWork<8>& work, const BvhView<false>& triangles, cudaEvent_t traced);
/// Where some of the surfaces are exact patches: threads that need ten times the memory.
cudaError_t launch_paths(const KernelWork<8>& work, const BvhView<true>& with_pieces, cudaEvent_t traced);

}  // namespace opal
