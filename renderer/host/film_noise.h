// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "renderer/host/film.h"

/// How noisy a picture is, from what its film holds. A pixel's noise in luminance is the standard error of its mean luminance
/// over that luminance, or over the picture's floor where it is darker. Its noise in chroma is the root mean square of the
/// standard errors of red-green and blue-yellow over the same, or over the larger of the two themselves where that is more (pure
/// blue has little luminance). Standard errors are of the means of groups of consecutive samples, so that what stratification
/// gains counts. A block's noise is the root mean square over its pixels: with few groups a pixel alone tells little about
/// itself, and stopping by it would favour pixels that look quiet because they missed something bright.
namespace opal {

/// Samples of every pixel before its noise is first asked for.
inline constexpr std::uint32_t least_samples_for_noise = 32;

/// Sample counts at which noise is looked at: the next one after `samples` of 32, 48, 64, 80, 112 ... growing by a quarter, in
/// whole groups. They do not depend on how a render is cut into passes.
std::uint32_t next_noise_look(std::uint32_t samples);

/// 5 % of (mean of sqrt luminance)^2: of the picture's mean brightness as eyes take it, which a few very bright pixels do not
/// move.
double measured_noise_floor(const Film& film);

struct NoiseLevel {
    double luminance = 0.0, chroma = 0.0;

    double larger() const { return luminance > chroma ? luminance : chroma; }
};

/// Noise of a block whose samples fill whole groups, at least two.
NoiseLevel block_noise(const Film& film, int block);

/// Median and 95th percentile over the picture's blocks, of what they had when last looked at.
struct PictureNoise {
    NoiseLevel median, percentile_95;
};
/// Nothing where any block was not looked at yet.
std::optional<PictureNoise> picture_noise(const Film& film);

}  // namespace opal
