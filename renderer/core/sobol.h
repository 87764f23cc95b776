// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/compat.h"

/// Sobol's sequence in four dimensions, scrambled as Owen does (nested uniform scrambling), so that every sample by itself is
/// uniform and every aligned block of 2^m samples is a net.
namespace opal {

/// Direction numbers of the first four dimensions, from the primitive polynomials and initial numbers of Joe & Kuo 2008
/// ("Constructing Sobol sequences with better two-dimensional projections", new-joe-kuo-6): degree, coefficients, m_1, m_2, m_3.
struct SobolDirections {
    uint32_t v[32][4] = {};  ///< of bit k of the index

    constexpr SobolDirections() {
        constexpr uint32_t degree[4] = {0, 1, 2, 3}, coefficients[4] = {0, 0, 1, 1};
        constexpr uint32_t initial[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 3, 0}, {1, 3, 1}};
        for (uint32_t k = 0; k < 32; ++k) v[k][0] = 1u << (31 - k);
        for (uint32_t d = 1; d < 4; ++d) {
            const uint32_t s = degree[d];
            for (uint32_t k = 0; k < 32; ++k) {
                if (k < s) {
                    v[k][d] = initial[d][k] << (31 - k);
                    continue;
                }
                v[k][d] = v[k - s][d] ^ (v[k - s][d] >> s);
                for (uint32_t j = 1; j < s; ++j)
                    if ((coefficients[d] >> (s - 1 - j)) & 1u) v[k][d] ^= v[k - j][d];
            }
        }
    }
};

struct SobolPoint {
    uint32_t value[4] = {};
};

/// Point number `index` of the sequence, as fractions of 2^32.
OPAL_HD inline SobolPoint sobol_point(uint32_t index) {
    static constexpr SobolDirections directions;
    SobolPoint point;
    for (int k = 0; k < 32; ++k) {
        const uint32_t mask = 0u - ((index >> k) & 1u);
        for (int d = 0; d < 4; ++d) point.value[d] ^= directions.v[k][d] & mask;
    }
    return point;
}

OPAL_HD inline uint32_t reversed_bits(uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x >> 8) & 0x00FF00FFu) | ((x & 0x00FF00FFu) << 8);
    x = ((x >> 4) & 0x0F0F0F0Fu) | ((x & 0x0F0F0F0Fu) << 4);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

/// Owen's scrambling of a fraction of 2^32: each bit is flipped or not by a hash of the bits above it and the seed (Laine &
/// Karras 2011, with the constants of Vegdahl 2021). Of an index it is a shuffle that keeps aligned blocks of 2^m together.
OPAL_HD inline uint32_t owen_scrambled(uint32_t x, uint32_t seed) {
    x = reversed_bits(x);
    x ^= x * 0x3D20ADEAu;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526C56u;
    x ^= x * 0x53A22864u;
    return reversed_bits(x);
}

}  // namespace opal
