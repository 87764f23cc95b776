// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/gradient_noise.h"

#include <algorithm>
#include <cmath>

#include "formats/units.h"

namespace opal {
namespace {

constexpr double lattice_period = 1 << 21;

std::uint64_t wrapped(double cell) {
    const double remainder = std::fmod(cell, lattice_period);
    return static_cast<std::uint64_t>(remainder < 0.0 ? remainder + lattice_period : remainder);
}

}  // namespace

openvdb::Vec3d lattice_gradient(const openvdb::Vec3d& lattice_point, const NoiseSource& source, std::uint32_t octave) {
    std::uint64_t index = 0;
    for (int axis = 0; axis < 3; ++axis) index = (index << 21) | wrapped(lattice_point[axis]);
    const RandomBlock random = random_block(source.seed, source.stream, index, source.first_block + octave);
    const double z = 2.0 * uniform_double(random.value[0], random.value[1]) - 1.0;
    const double azimuth_rad = 2.0 * units::pi * uniform_double(random.value[2], random.value[3]);
    const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
    return {radius * std::cos(azimuth_rad), radius * std::sin(azimuth_rad), z};
}

double gradient_noise(const openvdb::Vec3d& position, const NoiseSource& source, std::uint32_t octave) {
    const openvdb::Vec3d cell(std::floor(position.x()), std::floor(position.y()), std::floor(position.z()));
    const openvdb::Vec3d offset = position - cell;
    const double blended = blend_corners(offset, [&](int i, int j, int k) {
        const openvdb::Vec3d corner(i, j, k);
        return lattice_gradient(cell + corner, source, octave).dot(offset - corner);
    });
    return std::clamp(blended * gradient_noise_scale, -1.0, 1.0);
}

double fractal_noise(const openvdb::Vec3d& position, const NoiseSource& source, int octaves) {
    return fractal_sum(position, octaves,
                       [&](const openvdb::Vec3d& place, std::uint32_t octave) { return gradient_noise(place, source, octave); });
}

}  // namespace opal
