// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "modeler/bezier_symmetry.h"

namespace opal {

/// The ten patches that the Utah teapot is made of, in Newell's units, z up, spout along +x: M. Newell, 1975, in the proportions
/// and with the bottom of F. Crow, "The origins of the teapot", IEEE Computer Graphics and Applications 7(1), 1987. Turned and
/// mirrored copies make 32.
namespace teapot_patches {

/// Over the first quadrant, each with four turned copies.
extern const BezierNet rim, upper_body, lower_body, knob, lid, bottom;
/// Over y >= 0, each with its mirror image.
extern const BezierNet upper_handle, lower_handle, spout, spout_tip;

}  // namespace teapot_patches
}  // namespace opal
