// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/gradient_noise.h"

#include <algorithm>
#include <cmath>

#include "formats/random.h"
#include "formats/units.h"

namespace opal {
namespace {

/// The lattice repeats after this many cells along each axis.
constexpr double lattice_period = 1 << 21;

double fade(double t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

double mix(double t, double a, double b) {
    return a + t * (b - a);
}

std::uint64_t wrapped(double cell) {
    const double remainder = std::fmod(cell, lattice_period);
    return static_cast<std::uint64_t>(remainder < 0.0 ? remainder + lattice_period : remainder);
}

/// Gradient at a lattice point: uniform on the unit sphere.
openvdb::Vec3d gradient(const openvdb::Vec3d& lattice_point, std::uint64_t seed, std::uint32_t octave) {
    std::uint64_t index = 0;
    for (int axis = 0; axis < 3; ++axis) index = (index << 21) | wrapped(lattice_point[axis]);
    const RandomBlock random = random_block(seed, RandomStream::perlin_gradients, index, octave);
    const double z = 2.0 * uniform_double(random.value[0], random.value[1]) - 1.0;
    const double azimuth_rad = 2.0 * units::pi * uniform_double(random.value[2], random.value[3]);
    const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
    return {radius * std::cos(azimuth_rad), radius * std::sin(azimuth_rad), z};
}

}  // namespace

double gradient_noise(const openvdb::Vec3d& position, std::uint64_t seed, std::uint32_t octave) {
    const openvdb::Vec3d cell(std::floor(position.x()), std::floor(position.y()), std::floor(position.z()));
    const openvdb::Vec3d offset = position - cell;
    const auto slope_at = [&](double i, double j, double k) {
        const openvdb::Vec3d corner(i, j, k);
        return gradient(cell + corner, seed, octave).dot(offset - corner);
    };
    const openvdb::Vec3d t(fade(offset.x()), fade(offset.y()), fade(offset.z()));
    double planes[2];
    for (int k = 0; k < 2; ++k)
        planes[k] =
            mix(t.y(), mix(t.x(), slope_at(0, 0, k), slope_at(1, 0, k)), mix(t.x(), slope_at(0, 1, k), slope_at(1, 1, k)));
    return std::clamp(mix(t.z(), planes[0], planes[1]) * (2.0 / std::sqrt(3.0)), -1.0, 1.0);
}

double fractal_noise(const openvdb::Vec3d& position, std::uint64_t seed, int octaves) {
    double sum = 0.0, total_amplitude = 0.0, amplitude = 1.0;
    openvdb::Vec3d place = position;
    for (int octave = 0; octave < octaves; ++octave) {
        sum += amplitude * gradient_noise(place, seed, static_cast<std::uint32_t>(octave));
        total_amplitude += amplitude;
        amplitude *= 0.5;
        place *= 2.0;
    }
    return sum / total_amplitude;
}

}  // namespace opal
