// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "formats/bezier_patch.h"

namespace opal {

/// A closed body of eight patches about (x, 0, 0): an octant of an ellipsoid by cubic arcs, mirrored. Its poles are collapsed
/// edges.
inline std::vector<BezierPatch> round_body(double rx, double ry, double rz, double x = 0.0, int part = 0) {
    const double k = 4.0 / 3.0 * (std::sqrt(2.0) - 1.0);
    // A quarter circle from (1, 0) to (0, 1).
    const double arc[4][2] = {{1.0, 0.0}, {1.0, k}, {k, 1.0}, {0.0, 1.0}};
    std::vector<BezierPatch> patches;
    for (int octant = 0; octant < 8; ++octant) {
        const double sx = octant & 1 ? -1.0 : 1.0, sy = octant & 2 ? -1.0 : 1.0, sz = octant & 4 ? -1.0 : 1.0;
        const bool mirrored = sx * sy * sz < 0.0;
        BezierPatch patch;
        patch.part = part;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                const int around = mirrored ? 3 - i : i;  // keeps the normal outward
                const double c[3] = {x + sx * rx * arc[around][0] * arc[j][0], sy * ry * arc[around][1] * arc[j][0],
                                     sz * rz * arc[j][1]};
                for (int axis = 0; axis < 3; ++axis) patch.control_mm[i][j][axis] = c[axis];
            }
        patches.push_back(patch);
    }
    return patches;
}

}  // namespace opal
