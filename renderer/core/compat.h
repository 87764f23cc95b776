// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The one place that tells compilers and machines apart. Headers of renderer/core compile for host and device: no strings, no
/// exceptions, no OpenVDB, no TBB.
#if defined(__CUDACC__)
#define OPAL_HD __host__ __device__
#else
#define OPAL_HD
#endif

/// Large functions that a device's compiler is to keep as one copy: it would take minutes over each more.
#if defined(__CUDACC__)
#define OPAL_HD_LARGE __host__ __device__ __noinline__
#else
#define OPAL_HD_LARGE
#endif

/// Before a short loop over lanes without branches or calls: asks the host compiler to vectorize it.
#if defined(__GNUC__) && !defined(__CUDACC__)
#define OPAL_SIMD _Pragma("omp simd")
#define OPAL_PRAGMA(text) _Pragma(#text)
/// The same where the loop gathers with |= in the variable `any`.
#define OPAL_SIMD_ANY(any) OPAL_PRAGMA(omp simd reduction(| : any))
#else
#define OPAL_SIMD
#define OPAL_SIMD_ANY(any)
#endif

/// How many neighbours of a cell are looked at together: as many as a vector register holds on the host; a thread of a device
/// takes them one by one.
#if defined(__CUDA_ARCH__)
#define OPAL_CELL_LANES 1
#else
#define OPAL_CELL_LANES 8
#endif

#include <math.h>
#include <stdint.h>
