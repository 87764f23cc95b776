// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "gem_samples.h"

/// What separates a picture's bias from its noise: renders of the same pixels with several independent seeds.
namespace opal {

/// Mean of every pixel, for every seed.
using SeedPictures = std::vector<std::vector<Opponent>>;

struct Estimate {
    double value = 0.0, standard_error = 0.0;
};

/// Which pixels make up each patch.
using Patches = std::vector<std::vector<std::size_t>>;

/// Patches of edge x edge pixels of a picture of that width, of those `pixels` (places in rows), where at least half of a patch's
/// pixels are among them; indices are into `pixels`.
Patches patches_of(const std::vector<std::uint32_t>& pixels, int width, int edge);

/// Means over the patches in place of the pixels.
SeedPictures patch_means(const SeedPictures& pictures, const Patches& patches);

/// Weight of each pixel's squared error: 1 / (its squared luminance + a tenth of the mean of all), over the number of pixels:
/// errors are relative, but where it is darker than a third of the whole. From seeds of their own: a picture that is weighted by
/// its own noise seems quieter than others.
std::vector<double> relative_weights(const SeedPictures& reference);

/// Weighted mean over the pixels of the squared difference of what two pictures converge to, luminance and both chromas
/// together: no bias from noise (products of different seeds alone), so that it can come out negative. The smaller the more alike
/// the two pictures' samples of one seed are. Standard error by the jackknife over the seeds: up to 1.5 times
/// too large where there is no bias. At least two seeds.
Estimate squared_bias(const SeedPictures& picture, const SeedPictures& reference, const std::vector<double>& weights);

/// Weighted mean over the pixels of the variance of one seed's pixels, luminance and chroma together. Jackknife as above; at
/// least three seeds.
Estimate seed_variance(const SeedPictures& picture, const std::vector<double>& weights);

/// Mean luminance of all pixels over that of the reference, less one.
Estimate relative_mean_error(const SeedPictures& picture, const SeedPictures& reference);

}  // namespace opal
