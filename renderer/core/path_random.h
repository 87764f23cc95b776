// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/random.h"
#include "renderer/core/compat.h"

namespace opal {

/// The random numbers of one path: number k is a pure function of (seed, pixel, sample, k).
class PathRandom {
  public:
    OPAL_HD PathRandom(uint64_t seed, uint32_t pixel, uint32_t sample)
        : seed_(seed), index_((uint64_t(pixel) << 32) | sample), used_(4), next_block_(0) {}

    /// Uniform in [0, 1).
    OPAL_HD float next() { return uniform_float(next_bits()); }

    /// 32 random bits.
    OPAL_HD uint32_t next_bits() {
        if (used_ == 4) {
            block_ = random_block(seed_, RandomStream::render_paths, index_, next_block_++);
            used_ = 0;
        }
        return block_.value[used_++];
    }

  private:
    uint64_t seed_;
    uint64_t index_;
    RandomBlock block_ = {};
    uint32_t used_;
    uint32_t next_block_;
};

/// Low-discrepancy numbers for what all samples of a pixel share: the additive recurrence frac(scramble + sample * alpha) in
/// 32-bit fixed point, with a scramble per pixel and dimension. Any prefix of the samples is well spread, so no total has to be
/// known. Steps: the golden ratio for the wavelength; the plastic number's powers for the pixel position (Roberts 2018).
class PixelSequence {
  public:
    OPAL_HD PixelSequence(uint64_t seed, uint32_t pixel, uint32_t sample)
        : scramble_(random_block(seed, RandomStream::pixel_scramble, pixel, 0)), sample_(sample) {}

    OPAL_HD float wavelength() const { return uniform_float(scramble_.value[0] + sample_ * 0x9E3779B9u); }
    OPAL_HD float position_x() const { return uniform_float(scramble_.value[1] + sample_ * 0xC13FA9A9u); }
    OPAL_HD float position_y() const { return uniform_float(scramble_.value[2] + sample_ * 0x91E10DA5u); }

  private:
    RandomBlock scramble_;
    uint32_t sample_;
};

}  // namespace opal
