// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

namespace opal {

/// The perceptual colour map viridis (S. van der Walt & N. Smith, "A better default colormap for matplotlib", SciPy 2015; CC0) at
/// a position in [0, 1], clamped: M. Zucker's polynomial fit (CC0), within 0.02 of the table. Display-encoded sRGB.
openvdb::Vec3f viridis(double position);

/// Inverse pole figure colour of a direction in the lattice's frame (cubic axes), the same for the 48 directions that the cubic
/// point group m-3m makes of it: red where a <100> axis lies along it, green for <110>, blue for <111>, mixed between by the
/// direction's components along these three, the strongest of which is full. Display-encoded sRGB. (Conventions of such keys:
/// G. Nolze & R. Hielscher, "Orientations - perfectly colored", J. Appl. Cryst. 49, 2016.)
openvdb::Vec3f cubic_direction_color(const openvdb::Vec3d& direction);

}  // namespace opal
