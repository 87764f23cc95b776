// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <vector>

#include "formats/bezier_patch.h"

namespace opal {

/// A cabochon of eight bicubic patches, four above its girdle and four below, within extents of exactly `size_mm`, resting on z =
/// 0. The girdle, its widest outline, lies at z = `girdle_mm`; outline and profiles are quarter ellipses in the usual cubic
/// approximation, whose radius is up to 0.027 % too large.
///
/// Parameters run alike in neighbouring patches. Tangents across the meridians are equal in length and direction (C1); across the
/// girdle they are equal in direction, lengths in the ratio of the heights above and below it (G1; C1 where these are equal). At
/// the two poles, where an edge of four patches collapses, the limits of all normals are vertical. With `girdle_mm` 0 the base is
/// flat and the girdle a sharp edge.
std::vector<BezierPatch> bezier_cabochon(const openvdb::Vec3d& size_mm, double girdle_mm);

}  // namespace opal
