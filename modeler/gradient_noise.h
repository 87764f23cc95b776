// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>

namespace opal {

/// Smooth random field in [-1, 1], a pure function of (seed, octave, position); features are about one unit long. Gradient noise
/// of K. Perlin, "Improving noise", SIGGRAPH 2002 (quintic fade), with gradients uniform on the sphere from a counter-based hash.
/// Unit gradients bound the sum by sqrt(3)/2, reached in the middle of a cell; the result is divided by that.
double gradient_noise(const openvdb::Vec3d& position, std::uint64_t seed, std::uint32_t octave);

/// Fractional Brownian motion: octaves of gradient noise, each half as large and half as strong as the one before, in [-1, 1].
double fractal_noise(const openvdb::Vec3d& position, std::uint64_t seed, int octaves);

}  // namespace opal
