// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The one place that tells compilers and machines apart. Headers of renderer/core compile for host and device: no strings, no
/// exceptions, no OpenVDB, no TBB.
#if defined(__CUDACC__)
#define OPAL_HD __host__ __device__
#else
#define OPAL_HD
#endif

#include <math.h>
#include <stdint.h>
