// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/simplex_noise.h"

#include <algorithm>
#include <cmath>

namespace opal {
namespace {

constexpr double skew = 1.0 / 3.0;
constexpr double unskew = 1.0 / 6.0;
constexpr double squared_reach = 0.5;
/// Unit gradients bound the sum by the largest value of the sum of (1/2 - |x - c|^2)^4 |x - c| over the corners, which is
/// 0.00928906293, found at 0.1440 (1, 1, 1).
constexpr double noise_scale = 1.0 / 0.0092890630;

openvdb::Vec3d floor_of(const openvdb::Vec3d& v) {
    return {std::floor(v.x()), std::floor(v.y()), std::floor(v.z())};
}

/// What one corner adds; `offset` leads to the place from it.
double corner_part(const openvdb::Vec3d& offset, const openvdb::Vec3d& corner, const NoiseSource& source, std::uint32_t octave) {
    const double falloff = squared_reach - offset.lengthSqr();
    if (falloff <= 0.0) return 0.0;
    const double squared = falloff * falloff;
    return squared * squared * lattice_gradient(corner, source, octave).dot(offset);
}

}  // namespace

double simplex_noise(const openvdb::Vec3d& position, const NoiseSource& source, std::uint32_t octave) {
    const openvdb::Vec3d cell = floor_of(position + openvdb::Vec3d(skew * position.sum()));
    const openvdb::Vec3d offset = position - (cell - openvdb::Vec3d(unskew * cell.sum()));

    // The tetrahedron's edges climb the axes in the order of the offsets, the largest first.
    int order[3] = {0, 1, 2};
    std::stable_sort(order, order + 3, [&](int a, int b) { return offset[a] > offset[b]; });

    openvdb::Vec3d step(0.0);
    double sum = corner_part(offset, cell, source, octave);
    for (int n = 0; n < 3; ++n) {
        step[order[n]] = 1.0;
        sum += corner_part(offset - step + openvdb::Vec3d((n + 1) * unskew), cell + step, source, octave);
    }
    return std::clamp(sum * noise_scale, -1.0, 1.0);
}

double fractal_simplex_noise(const openvdb::Vec3d& position, const NoiseSource& source, int octaves) {
    return fractal_sum(position, octaves,
                       [&](const openvdb::Vec3d& place, std::uint32_t octave) { return simplex_noise(place, source, octave); });
}

}  // namespace opal
