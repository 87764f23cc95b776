// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "formats/bezier_patch.h"
#include "modeler/triangle_mesh.h"

namespace opal {

/// Into how many equal parts the parameters of a patch are divided.
struct PatchSplit {
    int along_u = 1;
    int along_v = 1;
};

/// Largest possible distance in mm between a patch and the triangles of its split, both ways: (M_uu / n_u^2 + 2 M_uv / (n_u n_v)
/// + M_vv / n_v^2) / 8, where M bounds the second derivatives by second differences of the control points. (D. Filip, R.
/// Magedson, R. Markot, "Surface algorithms using bounds on derivatives", CAGD 3(4), 1986, theorem 1.)
double chord_error_bound_mm(const BezierPatch& patch, const PatchSplit& split);

/// The coarsest uniform splits, as few triangles per patch as the bound allows, that keep every patch within `chord_error_mm`,
/// and in which patches that share an edge (the same control points, in either direction) divide it alike.
std::vector<PatchSplit> split_patches(const std::vector<BezierPatch>& patches, double chord_error_mm);

/// Loose triangles of split patches, facing as the patches do; those that collapse at a pole are left out. Points on a shared
/// edge are equal bit by bit. Throws InputError where `chord_error_mm` asks for too many triangles.
TriangleMesh tessellate(const std::vector<BezierPatch>& patches, double chord_error_mm);

}  // namespace opal
