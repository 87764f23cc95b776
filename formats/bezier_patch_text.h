// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "formats/bezier_patch.h"

namespace opal {

/// One line per patch: its part, then 16 control points (x y z, mm, v fastest), 49 numbers separated by spaces, which read back
/// to the same bits.
std::string bezier_patches_to_text(const std::vector<BezierPatch>& patches);

/// Throws InputError, naming the line, for anything else.
std::vector<BezierPatch> bezier_patches_from_text(const std::string& text);

}  // namespace opal
