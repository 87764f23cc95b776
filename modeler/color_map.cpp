// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/color_map.h"

#include <algorithm>
#include <cmath>

namespace opal {

openvdb::Vec3f viridis(double position) {
    static constexpr double coefficient[7][3] = {{0.2777273272234177, 0.005407344544966578, 0.3340998053353061},
                                                 {0.1050930431085774, 1.404613529898575, 1.384590162594685},
                                                 {-0.3308618287255563, 0.214847559468213, 0.09509516302823659},
                                                 {-4.634230498983486, -5.799100973351585, -19.33244095627987},
                                                 {6.228269936347081, 14.17993336680509, 56.69055260068105},
                                                 {4.776384997670288, -13.74514537774601, -65.35303263337234},
                                                 {-5.435455855934631, 4.645852612178535, 26.3124352495832}};
    const double t = std::clamp(position, 0.0, 1.0);
    openvdb::Vec3f color;
    for (int channel = 0; channel < 3; ++channel) {
        double value = 0.0;
        for (int power = 6; power >= 0; --power) value = value * t + coefficient[power][channel];
        color[channel] = static_cast<float>(std::clamp(value, 0.0, 1.0));
    }
    return color;
}

openvdb::Vec3f cubic_direction_color(const openvdb::Vec3d& direction) {
    double c[3] = {std::abs(direction.x()), std::abs(direction.y()), std::abs(direction.z())};
    std::sort(c, c + 3);
    // (c2, c1, c0) = (c2 - c1) [100] + (c1 - c0) [110] + c0 [111], each with the length of its lattice vector.
    const double part[3] = {c[2] - c[1], std::sqrt(2.0) * (c[1] - c[0]), std::sqrt(3.0) * c[0]};
    const double strongest = std::max({part[0], part[1], part[2]});
    if (!(strongest > 0.0)) return openvdb::Vec3f(0.0f);
    // The square root widens the bright mixtures between the corners.
    openvdb::Vec3f color;
    for (int channel = 0; channel < 3; ++channel) color[channel] = static_cast<float>(std::sqrt(part[channel] / strongest));
    return color;
}

}  // namespace opal
