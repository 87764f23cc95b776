// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string.h>

#include "renderer/core/real.h"

/// exp and log to single precision without branches or calls, so that a path's lanes vectorize on the host. A device has its own.
namespace opal {

/// e^x with a relative error below 3e-7; 0 below -87, and no more than e^88.
OPAL_HD inline float exponential(float x) {
#if defined(__CUDA_ARCH__)
    return expf(x);
#else
    const float clamped = x < -87.0f ? -87.0f : (x > 88.0f ? 88.0f : x);
    const float n = rintf(clamped * 1.44269504f);
    // ln 2 in two parts, the first of few digits: n times it is exact.
    const float r = (clamped - n * 0.693359375f) + n * 2.12194440e-4f;
    const float series =
        1.0f + r * (1.0f + r * (0.5f + r * (1.0f / 6.0f + r * (1.0f / 24.0f + r * (1.0f / 120.0f + r * (1.0f / 720.0f))))));
    const int32_t bits = (int32_t(n) + 127) << 23;
    float power;
    memcpy(&power, &bits, sizeof power);
    return x < -87.0f ? 0.0f : series * power;
#endif
}

/// Natural logarithm of a normal positive number, with an error below 3e-7 of the result.
OPAL_HD inline float logarithm(float x) {
#if defined(__CUDA_ARCH__)
    return logf(x);
#else
    // x = 2^n m with m in [1/sqrt 2, sqrt 2): the integer is the exponent of x over the smallest such m.
    int32_t bits;
    memcpy(&bits, &x, sizeof bits);
    const int32_t above = bits - 0x3F3504F3;
    const int32_t exponent = above >> 23;
    const int32_t mantissa_bits = (above & 0x007FFFFF) + 0x3F3504F3;
    float m;
    memcpy(&m, &mantissa_bits, sizeof m);
    const float n = float(exponent);
    // log m = 2 artanh s, s = (m - 1) / (m + 1), |s| < 0.172.
    const float f = m - 1.0f;
    const float s = f / (2.0f + f);
    const float s2 = s * s;
    const float tail = s2 * (2.0f / 3.0f + s2 * (2.0f / 5.0f + s2 * (2.0f / 7.0f + s2 * (2.0f / 9.0f))));
    // 2 s = f - s f: the part that rounds is small.
    return n * 0.693359375f + (f - (s * (f - tail) + n * 2.12194440e-4f));
#endif
}

#if defined(OPAL_DOUBLE_TRANSPORT)
/// Both by the library, as far as a double reaches, where the transport computes in it.
OPAL_HD inline double exponential(double x) {
    return exp(x);
}
OPAL_HD inline double logarithm(double x) {
    return log(x);
}
#endif

/// Optical depth to the next of events that come at random: exponentially distributed with mean 1. `u` is uniform in [0, 1).
OPAL_HD inline real free_depth(real u) {
    return -logarithm(1.0f - u);
}

}  // namespace opal
