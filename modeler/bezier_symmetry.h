// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "formats/bezier_patch.h"

namespace opal {

/// Control points of a patch as they are usually listed: four rows of four points (x, y, z).
using BezierNet = double[4][4][3];

/// Appends the patch of a net.
void add_patch(const BezierNet& net, int part, std::vector<BezierPatch>& patches);

/// Appends a patch over the first quadrant (v from the x to the y axis) and its copies turned by 90, 180 and 270 degrees about z.
/// Turning is exact: coordinates are exchanged.
void add_turned_patches(const BezierNet& net, int part, std::vector<BezierPatch>& patches);

/// Appends a patch over y >= 0, its columns running from y = 0 to y = 0, and its mirror image over y <= 0, which faces outward
/// too.
void add_mirrored_patches(const BezierNet& net, int part, std::vector<BezierPatch>& patches);

}  // namespace opal
