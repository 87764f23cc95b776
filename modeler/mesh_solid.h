// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "modeler/triangle_mesh.h"

namespace opal {

/// The solid that loose triangles bound: equal vertices merged, repeated and degenerate triangles dropped, seams stitched,
/// triangles turned to face outward. Throws InputError, naming the mesh by `name`, where the surface is open (with the number of
/// border edges and holes and the place of the first), intersects itself, or bounds no volume.
TriangleMesh solid_from_triangles(const TriangleMesh& soup, const std::string& name);

}  // namespace opal
