// SPDX-License-Identifier: GPL-3.0-or-later
#include "three_beam.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

namespace opal {
namespace {

using Amplitudes = std::array<std::complex<double>, 3>;

Amplitudes slope(const ThreeBeamSlab& slab, const Amplitudes& a) {
    const std::complex<double> i(0.0, 1.0);
    return {i * (slab.coupling[0] * a[1] + slab.coupling[1] * a[2]),
            -i * (slab.coupling[0] * a[0] + slab.cross * a[2] + 2.0 * slab.detuning[0] * a[1]),
            -i * (slab.coupling[1] * a[0] + slab.cross * a[1] + 2.0 * slab.detuning[1] * a[2])};
}

Amplitudes stepped(const Amplitudes& a, const Amplitudes& b, double length) {
    return {a[0] + length * b[0], a[1] + length * b[1], a[2] + length * b[2]};
}

}  // namespace

double three_beam_reflectance(const ThreeBeamSlab& slab) {
    // Nothing comes in through the far face: from there, the system is followed back (Runge & Kutta, fourth order).
    Amplitudes a = {1.0, 0.0, 0.0};
    const double rate = std::abs(slab.coupling[0]) + std::abs(slab.coupling[1]) + std::abs(slab.cross) +
                        2.0 * std::max(std::abs(slab.detuning[0]), std::abs(slab.detuning[1]));
    const int steps = 20 + int(10.0 * rate);
    const double h = -1.0 / steps;
    for (int n = 0; n < steps; ++n) {
        const Amplitudes k1 = slope(slab, a), k2 = slope(slab, stepped(a, k1, 0.5 * h)),
                         k3 = slope(slab, stepped(a, k2, 0.5 * h)), k4 = slope(slab, stepped(a, k3, h));
        for (std::size_t j = 0; j < 3; ++j) a[j] += h / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]);
    }
    return (std::norm(a[1]) + std::norm(a[2])) / std::norm(a[0]);
}

}  // namespace opal
