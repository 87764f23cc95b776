// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/cuda/path_kernels.h"

namespace opal {

/// Samples that one thread traces one after another: enough to even out paths of different lengths.
inline constexpr uint32_t samples_per_thread = 4;

__device__ inline void add_atomically(uint64_t& sum, uint64_t part) {
    if (part != 0) atomicAdd(reinterpret_cast<unsigned long long*>(&sum), static_cast<unsigned long long>(part));
}

/// One thread block per block of the film and run of samples; one thread per pixel. Counters are integers: in whatever order they
/// are added, the sums are the same.
template <int N, class Intersector>
__global__ void __launch_bounds__(block_pixels) trace_kernel(KernelWork<N> work, Intersector intersector) {
    PathCounters counters;
    const uint32_t first = blockIdx.y * samples_per_thread;
    trace_pixel(work.launch, intersector, blockIdx.x, int(threadIdx.x), first,
                min_of(work.launch.samples, first + samples_per_thread), work.records, counters);
    PathCounters& sums = work.counters[blockIdx.x];
    add_atomically(sums.diffractions, counters.diffractions);
    add_atomically(sums.turns_back, counters.turns_back);
    add_atomically(sums.scatterings, counters.scatterings);
    add_atomically(sums.grain_crossings, counters.grain_crossings);
    add_atomically(sums.multi_beam_stays, counters.multi_beam_stays);
    add_atomically(sums.lost_paths, counters.lost_paths);
    add_atomically(sums.truncated_paths, counters.truncated_paths);
    add_atomically(sums.not_a_number, counters.not_a_number);
    add_atomically(sums.majorant_violations, counters.majorant_violations);
}

template <int N>
__global__ void __launch_bounds__(block_pixels) add_kernel(KernelWork<N> work) {
    add_pixel(work.launch, work.records, blockIdx.x, int(threadIdx.x));
    if (threadIdx.x < num_total_parts)
        add_totals(work.launch, work.records, blockIdx.x, int(threadIdx.x), work.totals[blockIdx.x]);
}

template <int N, class Intersector>
cudaError_t queue_kernels(const KernelWork<N>& work, const Intersector& intersector, cudaEvent_t traced) {
    const dim3 blocks(work.launch.num_blocks, (work.launch.samples + samples_per_thread - 1) / samples_per_thread);
    trace_kernel<N, Intersector><<<blocks, block_pixels>>>(work, intersector);
    if (const cudaError_t error = cudaGetLastError(); error != cudaSuccess) return error;
    if (const cudaError_t error = cudaEventRecord(traced); error != cudaSuccess) return error;
    add_kernel<N><<<work.launch.num_blocks, block_pixels>>>(work);
    return cudaGetLastError();
}

}  // namespace opal
