// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#if defined(__CUDACC__)
#define OPAL_RANDOM_HD __host__ __device__
#else
#define OPAL_RANDOM_HD
#endif

/// Counter-based random numbers: every number is a pure function of (seed, stream, index, dimension), so results do not depend on
/// threads, order or earlier draws. Generator: Philox4x32-10, Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC
/// 2011. Shared by the modeler and by both backends of the renderer.
namespace opal {

struct RandomBlock {
    std::uint32_t value[4];
};

/// Philox4x32 with 10 rounds: four 32-bit words from a 128-bit counter and a 64-bit key.
OPAL_RANDOM_HD inline RandomBlock philox4x32(RandomBlock counter, std::uint32_t key0, std::uint32_t key1) {
    constexpr std::uint32_t multiplier0 = 0xD2511F53u, multiplier1 = 0xCD9E8D57u;
    constexpr std::uint32_t weyl0 = 0x9E3779B9u, weyl1 = 0xBB67AE85u;
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t product0 = std::uint64_t(multiplier0) * counter.value[0];
        const std::uint64_t product1 = std::uint64_t(multiplier1) * counter.value[2];
        counter = {{std::uint32_t(product1 >> 32) ^ counter.value[1] ^ key0, std::uint32_t(product1),
                    std::uint32_t(product0 >> 32) ^ counter.value[3] ^ key1, std::uint32_t(product0)}};
        key0 += weyl0;
        key1 += weyl1;
    }
    return counter;
}

/// Uniform in [0, 1): the top 24 bits, so that the float is exact and never rounds to 1.
OPAL_RANDOM_HD inline float uniform_float(std::uint32_t bits) {
    return float(bits >> 8) * 0x1p-24f;
}

/// Uniform in [0, 1) with 53 random bits.
OPAL_RANDOM_HD inline double uniform_double(std::uint32_t high, std::uint32_t low) {
    return double((std::uint64_t(high) << 21) ^ (low >> 11)) * 0x1p-53;
}

/// What a number is for; two purposes never share a stream. Renumbering one changes every output: append only.
enum class RandomStream : std::uint32_t {
    site_candidates = 1,
    perlin_gradients = 2,
    sintering_bonds = 3,
    grain_orientations = 4,
    render_paths = 5,
    foreign_orientations = 6,
    pixel_scramble = 7,
    lattice_jitter = 8,
    simplex_gradients = 9,
    boundary_noise = 10,
    field_noise = 11,
    field_grains = 12,
    site_orientations = 13,
    bench = 14,
    sobol_scramble = 15,
};

/// Block of four words for (seed, stream, index, block); the dimension is 4 * block + word.
OPAL_RANDOM_HD inline RandomBlock random_block(std::uint64_t seed, RandomStream stream, std::uint64_t index,
                                               std::uint32_t block) {
    return philox4x32({{std::uint32_t(index), std::uint32_t(index >> 32), block, std::uint32_t(stream)}}, std::uint32_t(seed),
                      std::uint32_t(seed >> 32));
}

}  // namespace opal
