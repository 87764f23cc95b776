// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/ellipsoid_distance.h"

#include <algorithm>
#include <cmath>

namespace opal {
namespace {

constexpr int max_newton_steps = 200;

/// The problem in units of the smallest semi-axis: sum (numerator_i / (u + offset_i))^2 = 1 with u = t / e_min^2 + 1 > 0.
/// Counting u from the pole keeps its relative accuracy for points near the middle plane.
template <std::size_t N>
struct FootEquation {
    std::array<double, N> numerator;
    std::array<double, N> offset;

    double excess(double u) const {
        double sum = -1.0;
        for (std::size_t i = 0; i < N; ++i) {
            if (numerator[i] == 0.0) continue;
            const double term = numerator[i] / (u + offset[i]);
            sum += term * term;
        }
        return sum;
    }

    /// Each term alone is at least 1 up to some u; the largest of these lies left of the root.
    double lower_bound() const {
        double bound = 0.0;
        for (std::size_t i = 0; i < N; ++i) bound = std::max(bound, numerator[i] - offset[i]);
        return bound;
    }

    double root() const {
        double u = lower_bound();
        for (int step_count = 0; step_count < max_newton_steps; ++step_count) {
            double value = -1.0;
            double slope = 0.0;
            for (std::size_t i = 0; i < N; ++i) {
                if (numerator[i] == 0.0) continue;
                const double inverse = 1.0 / (u + offset[i]);
                const double square = numerator[i] * inverse * numerator[i] * inverse;
                value += square;
                slope += 2.0 * square * inverse;
            }
            const double step = value / slope;
            if (!(step > 1.0e-16 * u)) break;
            u += step;
        }
        return u;
    }
};

}  // namespace

template <std::size_t N>
double signed_distance_to_ellipsoid(const std::array<double, N>& semi_axes, const std::array<double, N>& point) {
    const double smallest = *std::min_element(semi_axes.begin(), semi_axes.end());
    std::array<double, N> p;
    FootEquation<N> equation;
    bool has_pole = false;
    for (std::size_t i = 0; i < N; ++i) {
        // The distance changes by no more than the point moves: a coordinate this small may be called zero.
        p[i] = std::abs(point[i]) < 1.0e-14 * smallest ? 0.0 : std::abs(point[i]);
        const double ratio = semi_axes[i] / smallest;
        equation.offset[i] = (ratio - 1.0) * (ratio + 1.0);
        equation.numerator[i] = ratio * p[i] / smallest;
        has_pole = has_pole || (equation.offset[i] == 0.0 && p[i] > 0.0);
    }

    if (!has_pole) {
        // The point lies in the middle plane of the shortest axis; near enough to the centre, the foot leaves that plane.
        const double excess_at_pole = equation.excess(0.0);
        if (excess_at_pole <= 0.0) {
            double squared = -excess_at_pole * smallest * smallest;
            for (std::size_t i = 0; i < N; ++i)
                if (p[i] > 0.0) squared += (p[i] / equation.offset[i]) * (p[i] / equation.offset[i]);
            return -std::sqrt(squared);
        }
    }
    const double u = equation.root();
    double squared = 0.0;
    for (std::size_t i = 0; i < N; ++i) {
        if (p[i] == 0.0) continue;
        const double component = p[i] / (u + equation.offset[i]);
        squared += component * component;
    }
    return (u - 1.0) * std::sqrt(squared);
}

template double signed_distance_to_ellipsoid<2>(const std::array<double, 2>&, const std::array<double, 2>&);
template double signed_distance_to_ellipsoid<3>(const std::array<double, 3>&, const std::array<double, 3>&);

}  // namespace opal
