// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>

#include "formats/random.h"

namespace opal {

/// Where a noise takes its random gradients from. Noises of different sources are independent; one noise of n octaves uses the
/// blocks first_block to first_block + n - 1.
struct NoiseSource {
    std::uint64_t seed = 0;
    RandomStream stream = RandomStream::perlin_gradients;
    std::uint32_t first_block = 0;
};

/// No noise has more octaves, so that sources this many blocks apart are independent.
inline constexpr std::uint32_t max_octaves = 16;

/// The unit vector at a point of the integer lattice, uniform on the sphere: a pure function of its arguments. The lattice
/// repeats after 2^21 points along each axis.
openvdb::Vec3d lattice_gradient(const openvdb::Vec3d& lattice_point, const NoiseSource& source, std::uint32_t octave);

/// Blends the values at a cell's eight corners, value_at(i, j, k) with i, j, k of 0 or 1, by K. Perlin's quintic fade ("Improving
/// noise", SIGGRAPH 2002); `offset` is the place in the unit cell.
template <typename ValueAt>
auto blend_corners(const openvdb::Vec3d& offset, const ValueAt& value_at) {
    const auto fade = [](double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); };
    const auto mix = [](double t, const auto& a, const auto& b) { return a + t * (b - a); };
    const openvdb::Vec3d t(fade(offset.x()), fade(offset.y()), fade(offset.z()));
    const auto plane = [&](int k) {
        return mix(t.y(), mix(t.x(), value_at(0, 0, k), value_at(1, 0, k)), mix(t.x(), value_at(0, 1, k), value_at(1, 1, k)));
    };
    return mix(t.z(), plane(0), plane(1));
}

/// Unit gradients bound the blended sum by sqrt(3)/2, reached in the middle of a cell; the noise is divided by that.
inline constexpr double gradient_noise_scale = 1.1547005383792517;  // 2 / sqrt(3)
/// Largest slope of that noise: 2/sqrt(3) times the supremum, over places x and directions v, of the sum of the lengths of
/// d/dv (W_c(x) (x - c)) over the corners c with their blending weights W_c. It lies in the middle of a cell, along an axis:
/// 16/sqrt(3) sqrt((1/8 - 15/64)^2 + 2 (15/64)^2) = 3.22426.
inline constexpr double gradient_noise_slope = 3.2243;

/// Smooth random field in [-1, 1], a pure function of its arguments; features are about one unit long. Gradient noise of K.
/// Perlin, "Improving noise", SIGGRAPH 2002, with gradients uniform on the sphere from a counter-based hash.
double gradient_noise(const openvdb::Vec3d& position, const NoiseSource& source, std::uint32_t octave);

/// Fractional Brownian motion: octaves of `noise(position, octave)`, each half as large and half as strong as the one before,
/// divided by the sum of their strengths.
template <typename Noise>
double fractal_sum(const openvdb::Vec3d& position, int octaves, const Noise& noise) {
    double sum = 0.0, total_amplitude = 0.0, amplitude = 1.0;
    openvdb::Vec3d place = position;
    for (int octave = 0; octave < octaves; ++octave) {
        sum += amplitude * noise(place, static_cast<std::uint32_t>(octave));
        total_amplitude += amplitude;
        amplitude *= 0.5;
        place *= 2.0;
    }
    return sum / total_amplitude;
}

/// Fractional Brownian motion of gradient noise, in [-1, 1].
double fractal_noise(const openvdb::Vec3d& position, const NoiseSource& source, int octaves);

}  // namespace opal
