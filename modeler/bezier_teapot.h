// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "formats/bezier_patch.h"

namespace opal {

/// Number of parts of the teapot: body with lid, handle, spout.
inline constexpr int teapot_parts = 3;

/// The Utah teapot as a solid block: Newell's 32 patches in the order of the classical list, then 8 that close them. The 32 are
/// open sheets, so a flat ring closes the gap between the lid's edge and the rim, and flat caps close the open ends of the handle
/// and of the spout. That makes three closed parts; the handle's two ends and the spout's lower one lie inside the body (the
/// handle's touches its surface in one point), and the union of the parts is the solid.
///
/// The longest side of the patches' exact bounds is `longest_mm`; the other sides are in proportion. The bounds are centred in x
/// and y and rest on z = 0; the spout points along +x.
std::vector<BezierPatch> bezier_teapot(double longest_mm);

}  // namespace opal
