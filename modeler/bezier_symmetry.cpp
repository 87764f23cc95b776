// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/bezier_symmetry.h"

namespace opal {
namespace {

/// Zero instead of minus zero: texts and comparisons then see one point.
double without_sign_of_zero(double value) {
    return value + 0.0;
}

}  // namespace

void add_patch(const BezierNet& net, int part, std::vector<BezierPatch>& patches) {
    BezierPatch patch;
    patch.part = part;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            for (int axis = 0; axis < 3; ++axis) patch.control_mm[i][j][axis] = without_sign_of_zero(net[i][j][axis]);
    patches.push_back(patch);
}

void add_turned_patches(const BezierNet& net, int part, std::vector<BezierPatch>& patches) {
    BezierNet turned;
    for (int quarter = 0; quarter < 4; ++quarter) {
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                const auto& [x, y, z] = net[i][j];
                const double cosine[] = {1.0, 0.0, -1.0, 0.0}, sine[] = {0.0, 1.0, 0.0, -1.0};
                turned[i][j][0] = cosine[quarter] * x - sine[quarter] * y;
                turned[i][j][1] = sine[quarter] * x + cosine[quarter] * y;
                turned[i][j][2] = z;
            }
        add_patch(turned, part, patches);
    }
}

void add_mirrored_patches(const BezierNet& net, int part, std::vector<BezierPatch>& patches) {
    BezierNet mirrored;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            mirrored[i][j][0] = net[i][3 - j][0];
            mirrored[i][j][1] = -net[i][3 - j][1];
            mirrored[i][j][2] = net[i][3 - j][2];
        }
    add_patch(net, part, patches);
    add_patch(mirrored, part, patches);
}

}  // namespace opal
