// SPDX-License-Identifier: Apache-2.0
#include "formats/opal_asset.h"

#include <algorithm>
#include <cmath>

#include "formats/random.h"
#include "formats/units.h"

namespace opal {

void initialize_openvdb() {
    openvdb::initialize();
}

openvdb::math::Quat<float> uniform_rotation(std::uint64_t seed, RandomStream stream, std::uint64_t index) {
    const RandomBlock first = random_block(seed, stream, index, 0), second = random_block(seed, stream, index, 1);
    const double u1 = uniform_double(first.value[0], first.value[1]);
    const double angle2 = 2.0 * units::pi * uniform_double(first.value[2], first.value[3]);
    const double angle3 = 2.0 * units::pi * uniform_double(second.value[0], second.value[1]);
    const double a = std::sqrt(1.0 - u1), b = std::sqrt(u1);
    return {float(a * std::sin(angle2)), float(a * std::cos(angle2)), float(b * std::sin(angle3)), float(b * std::cos(angle3))};
}

openvdb::math::Quat<float> random_orientation(std::uint64_t seed, bool foreign, std::uint64_t grain) {
    return uniform_rotation(seed, foreign ? RandomStream::foreign_orientations : RandomStream::grain_orientations, grain);
}

openvdb::Vec3f grain_display_color(std::int32_t grain) {
    if (grain <= 0) return openvdb::Vec3f(0.2f);
    const double hue = 6.0 * (double(grain) * 0.61803398874989485 - std::floor(double(grain) * 0.61803398874989485));
    const auto channel = [&](double offset) {
        const double k = std::fmod(hue + offset, 6.0);
        return float(0.25 + 0.65 * std::clamp(std::abs(k - 3.0) - 1.0, 0.0, 1.0));
    };
    return {channel(0.0), channel(4.0), channel(2.0)};
}

}  // namespace opal
