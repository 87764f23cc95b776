// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cstddef>
#include <vector>

namespace opal {

/// Radius of the densest packing of `count` points in `volume`: half the shortest distance that they could have at most, away
/// from the border (Yuksel 2015, equation 2): cbrt(volume / (4 sqrt(2) count)).
double packing_radius(double volume, std::size_t count);

/// Thins out random samples to exactly `target` of them with the distribution of a Poisson disk: again and again the sample in
/// the most crowded place goes, crowding being the sum of (1 - d / (2 r_max))^8 over the neighbours at distance d < 2 r_max.
/// Distances below 2 r_max * 0.65 (1 - (target / samples)^1.5) count as that, since such pairs cannot stay together anyway. (C.
/// Yuksel, "Sample elimination for generating Poisson disk sample sets", Computer Graphics Forum 34(2), 2015, equations 2-4.)
/// Crowding is summed in fixed point, 62 bits for the highest sum that is possible. Ties go to the lowest index. Returns the
/// survivors' indices, ascending, the same for any number of threads. Throws Interrupted on Ctrl-C.
std::vector<std::size_t> eliminate_samples(const std::vector<openvdb::Vec3d>& samples, std::size_t target, double r_max);

}  // namespace opal
