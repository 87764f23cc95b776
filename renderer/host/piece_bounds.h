// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/bezier_hit.h"

namespace opal {

struct PieceBounds {
    float low[3], high[3];
};

/// Bounds of a piece: those of its control points, and a float's rounding.
PieceBounds piece_bounds(const PatchPiece& piece);

}  // namespace opal
