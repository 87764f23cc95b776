// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

namespace opal {

/// Signed distance, negative inside, from `point` to the ellipse (N = 2) or ellipsoid (N = 3) about the origin with the given
/// positive semi-axes; same length unit for all. Exact to rounding: relative to the largest extent, about 1e-14.
///
/// The foot y of the perpendicular satisfies y_i = e_i^2 p_i / (t + e_i^2), where t > -e_min^2 is the largest root of
/// sum (e_i p_i / (t + e_i^2))^2 = 1 (D. Eberly, "Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid", 2013).
/// The left side is convex and falls, so Newton's iteration from a point left of the root climbs to it without overshooting,
/// which needs some 5 steps where bisection takes 50.
template <std::size_t N>
double signed_distance_to_ellipsoid(const std::array<double, N>& semi_axes, const std::array<double, N>& point);

extern template double signed_distance_to_ellipsoid<2>(const std::array<double, 2>&, const std::array<double, 2>&);
extern template double signed_distance_to_ellipsoid<3>(const std::array<double, 3>&, const std::array<double, 3>&);

}  // namespace opal
