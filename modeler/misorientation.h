// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/math/Quat.h>

namespace opal {

/// The smallest angle, in radians, of a rotation that carries one cubic lattice into the other: 0 to `max_misorientation_rad`.
/// The two are unit quaternions (x, y, z, w), lattice -> world. Of the 24 rotations of a cube, the best is found from the sorted
/// magnitudes a >= b >= c >= d of the components of q1^-1 q2: cos(angle / 2) is the largest of a, (a + b) / sqrt 2 and
/// (a + b + c + d) / 2 (H. Grimmer, "Disorientations and coincidence rotations for cubic lattices", Acta Cryst. A 30, 1974).
double misorientation_angle_rad(const openvdb::math::Quat<float>& q1, const openvdb::math::Quat<float>& q2);

/// The largest misorientation of two cubic lattices, 2 acos((2 + sqrt 2) / 4): 62.80 degrees.
extern const double max_misorientation_rad;

/// Distribution of the misorientation angle of two independent, uniformly random cubic lattices, per radian; 0 outside
/// [0, max_misorientation_rad]. J. K. Mackenzie, "Second paper on statistics associated with the random disorientation of cubes",
/// Biometrika 45, 1958.
double mackenzie_density(double angle_rad);

/// Its integral from 0, exact to 1e-6.
double mackenzie_distribution(double angle_rad);

}  // namespace opal
