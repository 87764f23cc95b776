// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <vector>

#include "formats/bezier_patch.h"

namespace opal {

/// The smallest axis-aligned box around the patches themselves (not their control points), to 1e-12 of its size: each extreme
/// coordinate is bracketed by halving patches, whose control points bound it from outside and whose corners from inside.
openvdb::BBoxd bezier_bounds_mm(const std::vector<BezierPatch>& patches);

}  // namespace opal
