// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/misorientation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "formats/units.h"

namespace opal {
namespace {

using Quatd = openvdb::math::Quat<double>;

const double sqrt2 = std::sqrt(2.0);
/// Where the density bends: the faces of the cubes' fundamental zone are reached one kind after the other.
const std::array<double, 5> bends_rad = {0.0, 0.25 * units::pi, units::pi / 3.0, 2.0 * std::atan(2.0 - sqrt2),
                                         2.0 * std::acos((2.0 + sqrt2) / 4.0)};

Quatd in_double(const openvdb::math::Quat<float>& q) {
    return Quatd(q.x(), q.y(), q.z(), q.w());
}

double squared(double x) {
    return x * x;
}

/// The last piece's correction, where corners of the zone are left over.
double corner_term(double angle_rad) {
    const double t = 1.0 / std::tan(0.5 * angle_rad);
    const double x = (sqrt2 - 1.0) / std::sqrt(1.0 - squared((sqrt2 - 1.0) * t));
    const double y = squared(sqrt2 - 1.0) / std::sqrt(3.0 - t * t);
    const auto arc = [](double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); };
    return 8.0 / (5.0 * units::pi) *
           ((2.0 * arc((sqrt2 + 1.0) * x / sqrt2) + arc((sqrt2 + 1.0) * y / sqrt2)) * (1.0 - std::cos(angle_rad)) -
            (2.0 * (sqrt2 - 1.0) * arc(x * t) + arc(y * t) / std::sqrt(3.0)) * std::sin(angle_rad));
}

}  // namespace

const double max_misorientation_rad = bends_rad.back();

double misorientation_angle_rad(const openvdb::math::Quat<float>& q1, const openvdb::math::Quat<float>& q2) {
    const Quatd difference = in_double(q1).conjugate() * in_double(q2);
    std::array<double, 4> m = {std::abs(difference.x()), std::abs(difference.y()), std::abs(difference.z()),
                               std::abs(difference.w())};
    std::sort(m.begin(), m.end(), std::greater<>());
    const auto [a, b, c, d] = m;
    const double fourfold = (a + b) / sqrt2, threefold = 0.5 * (a + b + c + d);
    // Of each candidate, the vector part beside it: the arc tangent keeps small angles exact, and the length cancels.
    if (a >= fourfold && a >= threefold) return 2.0 * std::atan2(std::sqrt(b * b + c * c + d * d), a);
    if (fourfold >= threefold)
        return 2.0 * std::atan2(std::sqrt(0.5 * (squared(a - b) + squared(c + d) + squared(c - d))), fourfold);
    return 2.0 * std::atan2(0.5 * std::sqrt(squared(a + b - c - d) + squared(a - b + c - d) + squared(a - b - c + d)), threefold);
}

double mackenzie_density(double angle_rad) {
    if (angle_rad <= bends_rad[0] || angle_rad >= bends_rad[4]) return 0.0;
    const double sine = std::sin(angle_rad), versine = 1.0 - std::cos(angle_rad);
    // Mackenzie's constants are per degree: 2/15 of them is 24/pi per radian.
    const double per_rad = 180.0 / units::pi;
    if (angle_rad <= bends_rad[1]) return per_rad * 2.0 / 15.0 * versine;
    if (angle_rad <= bends_rad[2]) return per_rad * 2.0 / 15.0 * (3.0 * (sqrt2 - 1.0) * sine - 2.0 * versine);
    const double all_faces = 2.0 / 15.0 * ((3.0 * (sqrt2 - 1.0) + 4.0 / std::sqrt(3.0)) * sine - 6.0 * versine);
    return per_rad * (all_faces + (angle_rad <= bends_rad[3] ? 0.0 : corner_term(angle_rad)));
}

double mackenzie_distribution(double angle_rad) {
    // Simpson's rule on each piece, where the density is smooth; its end, where it is 0 with a finite slope, included.
    constexpr int steps = 200;
    double sum = 0.0;
    for (std::size_t piece = 1; piece < bends_rad.size(); ++piece) {
        const double from = bends_rad[piece - 1], to = std::clamp(angle_rad, from, bends_rad[piece]);
        const double width = (to - from) / steps;
        for (int n = 0; n <= steps; ++n)
            sum += (n == 0 || n == steps ? 1.0 : n % 2 == 1 ? 4.0 : 2.0) * mackenzie_density(from + n * width) * width / 3.0;
    }
    return sum;
}

}  // namespace opal
