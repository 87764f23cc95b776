// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "formats/random.h"

namespace opal {
namespace {

struct KnownAnswer {
    RandomBlock counter;
    std::uint32_t key0, key1;
    RandomBlock expected;
};

/// Known answers of Philox4x32-10 published with Random123 (Salmon et al. 2011).
const KnownAnswer known_answers[] = {
    {{{0, 0, 0, 0}}, 0, 0, {{0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u}}},
    {{{0xffffffffu, 0xffffffffu, 0xffffffffu, 0xffffffffu}},
     0xffffffffu,
     0xffffffffu,
     {{0x408f276du, 0x41c83b0eu, 0xa20bc7c6u, 0x6d5451fdu}}},
    {{{0x243f6a88u, 0x85a308d3u, 0x13198a2eu, 0x03707344u}},
     0xa4093822u,
     0x299f31d0u,
     {{0xd16cfe09u, 0x94fdccebu, 0x5001e420u, 0x24126ea1u}}},
};

TEST(Philox, KnownAnswers) {
    for (const KnownAnswer& known : known_answers) {
        const RandomBlock block = philox4x32(known.counter, known.key0, known.key1);
        for (int i = 0; i < 4; ++i) EXPECT_EQ(block.value[i], known.expected.value[i]);
    }
}

TEST(Philox, UniformsStayBelowOne) {
    EXPECT_LT(uniform_float(0xffffffffu), 1.0f);
    EXPECT_LT(uniform_double(0xffffffffu, 0xffffffffu), 1.0);
    EXPECT_EQ(uniform_float(0), 0.0f);
}

TEST(Philox, StreamsAndSeedsDiffer) {
    const RandomBlock a = random_block(1, RandomStream::render_paths, 5, 0);
    EXPECT_NE(a.value[0], random_block(2, RandomStream::render_paths, 5, 0).value[0]);
    EXPECT_NE(a.value[0], random_block(1, RandomStream::sintering_bonds, 5, 0).value[0]);
    EXPECT_NE(a.value[0], random_block(1, RandomStream::render_paths, 5ull << 32, 0).value[0]);
    EXPECT_NE(a.value[0], random_block(1ull << 32, RandomStream::render_paths, 5, 0).value[0]);
}

}  // namespace
}  // namespace opal
