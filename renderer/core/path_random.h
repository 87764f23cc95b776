// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/random.h"
#include "renderer/core/real.h"
#include "renderer/core/sobol.h"

namespace opal {

/// How the numbers of a pixel's samples relate. In every case number k of a path is a pure function of (seed, pixel, sample, k)
/// and any prefix of the samples is well spread, so that no total has to be known.
enum class PathSampler {
    sobol,       ///< the first numbers are Owen-scrambled Sobol points over the samples
    stratified,  ///< the wavelength and the place in the pixel follow additive recurrences
    independent
};

/// Low-discrepancy numbers for what all samples of a pixel share: the additive recurrence frac(scramble + sample * alpha) in
/// 32-bit fixed point, with a scramble per pixel and dimension. Steps: the golden ratio for the wavelength; the plastic number's
/// powers for the pixel position (Roberts 2018).
class PixelSequence {
  public:
    OPAL_HD PixelSequence(uint64_t seed, uint32_t pixel, uint32_t sample)
        : scramble_(random_block(seed, RandomStream::pixel_scramble, pixel, 0)), sample_(sample) {}

    OPAL_HD real wavelength() const { return uniform_float(scramble_.value[0] + sample_ * 0x9E3779B9u); }
    OPAL_HD real position_x() const { return uniform_float(scramble_.value[1] + sample_ * 0xC13FA9A9u); }
    OPAL_HD real position_y() const { return uniform_float(scramble_.value[2] + sample_ * 0x91E10DA5u); }

  private:
    RandomBlock scramble_;
    uint32_t sample_;
};

/// What decides a sample before its path begins.
struct PixelNumbers {
    real wavelength, x, y;
};

/// The random numbers of one path.
class PathRandom {
  public:
    OPAL_HD PathRandom(uint64_t seed, uint32_t pixel, uint32_t sample, PathSampler sampler = PathSampler::independent)
        : seed_(seed), index_((uint64_t(pixel) << 32) | sample), sampler_(sampler) {}

    /// The first numbers; drawn once, before all others.
    OPAL_HD PixelNumbers pixel_numbers() {
        if (sampler_ == PathSampler::stratified) {
            const PixelSequence sequence(seed_, uint32_t(index_ >> 32), uint32_t(index_));
            return {sequence.wavelength(), sequence.position_x(), sequence.position_y()};
        }
        const real wavelength = next(), x = next(), y = next();
        if (sampler_ == PathSampler::sobol) points_used_ = 4;
        return {wavelength, x, y};
    }

    /// Uniform in [0, 1).
    OPAL_HD real next() {
        if (sampler_ == PathSampler::sobol && (points_used_ < 4 || group_ < sobol_groups)) return uniform_float(next_sobol());
        return uniform_float(next_bits());
    }

    /// 32 random bits.
    OPAL_HD uint32_t next_bits() {
        if (used_ == 4) {
            block_ = random_block(seed_, RandomStream::render_paths, index_, next_block_++);
            used_ = 0;
        }
        return block_.value[used_++];
    }

  private:
    /// Groups of four numbers that are drawn from Sobol points; what a path decides later is independent between samples.
    static constexpr uint32_t sobol_groups = 5;

    /// Every group is the same sequence, scrambled and visited in an order of its own (padding: Burley 2020, "Practical
    /// hash-based Owen scrambling").
    OPAL_HD uint32_t next_sobol() {
        if (points_used_ == 4) {
            const uint64_t group = (index_ & 0xFFFFFFFF00000000u) | group_++;
            scramble_ = random_block(seed_, RandomStream::sobol_scramble, group, 0);
            const uint32_t order = random_block(seed_, RandomStream::sobol_scramble, group, 1).value[0];
            point_ = sobol_point(owen_scrambled(uint32_t(index_), order));
            points_used_ = 0;
        }
        const uint32_t d = points_used_++;
        return owen_scrambled(point_.value[d], scramble_.value[d]);
    }

    uint64_t seed_;
    uint64_t index_;  ///< pixel, sample
    PathSampler sampler_;
    RandomBlock block_ = {};
    uint32_t used_ = 4;
    uint32_t next_block_ = 0;
    SobolPoint point_;
    RandomBlock scramble_ = {};
    uint32_t points_used_ = 4;
    uint32_t group_ = 0;
};

}  // namespace opal
