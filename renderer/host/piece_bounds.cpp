// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/piece_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace opal {

PieceBounds piece_bounds(const PatchPiece& piece) {
    PieceBounds bounds;
    for (int axis = 0; axis < 3; ++axis) {
        double least = std::numeric_limits<double>::infinity(), most = -least;
        for (const auto& row : piece.control_mm[axis])
            for (const double coordinate : row) {
                least = std::min(least, coordinate);
                most = std::max(most, coordinate);
            }
        const double rounding = 1.0e-6 * (1.0e-3 + std::max(std::abs(least), std::abs(most)));
        bounds.low[axis] = float(least - rounding);
        bounds.high[axis] = float(most + rounding);
    }
    return bounds;
}

}  // namespace opal
