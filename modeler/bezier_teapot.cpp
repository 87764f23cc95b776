// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/bezier_teapot.h"

#include <algorithm>

#include "modeler/bezier_bounds.h"
#include "modeler/bezier_symmetry.h"
#include "modeler/teapot_patches.h"

namespace opal {
namespace {

enum Part { body, handle, spout };

/// A patch that runs straight from one edge of four control points to another.
void add_ruled_patches(const double (&from)[4][3], const double (&to)[4][3], int part, bool turned,
                       std::vector<BezierPatch>& patches) {
    BezierNet net;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            for (int axis = 0; axis < 3; ++axis)
                net[i][j][axis] = i == 3 ? to[j][axis] : from[j][axis] + (i / 3.0) * (to[j][axis] - from[j][axis]);
    if (turned)
        add_turned_patches(net, part, patches);
    else
        add_patch(net, part, patches);
}

/// A flat patch over the opening between a half loop of y >= 0 and its mirror image.
void add_cap(const double (&half_loop)[4][3], bool at_the_end, int part, std::vector<BezierPatch>& patches) {
    double mirrored[4][3];
    for (int j = 0; j < 4; ++j) {
        mirrored[j][0] = half_loop[j][0];
        mirrored[j][1] = -half_loop[j][1];
        mirrored[j][2] = half_loop[j][2];
    }
    if (at_the_end)
        add_ruled_patches(half_loop, mirrored, part, false, patches);
    else
        add_ruled_patches(mirrored, half_loop, part, false, patches);
}

std::vector<BezierPatch> closed_teapot() {
    namespace newell = teapot_patches;
    std::vector<BezierPatch> patches;
    add_turned_patches(newell::rim, body, patches);
    add_turned_patches(newell::upper_body, body, patches);
    add_turned_patches(newell::lower_body, body, patches);
    add_mirrored_patches(newell::upper_handle, handle, patches);
    add_mirrored_patches(newell::lower_handle, handle, patches);
    add_mirrored_patches(newell::spout, spout, patches);
    add_mirrored_patches(newell::spout_tip, spout, patches);
    add_turned_patches(newell::knob, body, patches);
    add_turned_patches(newell::lid, body, patches);
    add_turned_patches(newell::bottom, body, patches);

    add_ruled_patches(newell::lid[3], newell::rim[0], body, true, patches);
    add_cap(newell::upper_handle[0], false, handle, patches);
    add_cap(newell::lower_handle[3], true, handle, patches);
    add_cap(newell::spout[0], false, spout, patches);
    add_cap(newell::spout_tip[3], true, spout, patches);
    return patches;
}

}  // namespace

std::vector<BezierPatch> bezier_teapot(double longest_mm) {
    std::vector<BezierPatch> patches = closed_teapot();
    const openvdb::BBoxd bounds = bezier_bounds_mm(patches);
    const openvdb::Vec3d extents = bounds.extents();
    const double scale = longest_mm / std::max({extents.x(), extents.y(), extents.z()});
    const openvdb::Vec3d middle = bounds.getCenter();
    const openvdb::Vec3d foot(middle.x(), middle.y(), bounds.min().z());
    for (BezierPatch& patch : patches)
        for (auto& row : patch.control_mm)
            for (auto& point : row)
                for (int axis = 0; axis < 3; ++axis) point[axis] = scale * (point[axis] - foot[axis]) + 0.0;
    return patches;
}

}  // namespace opal
