// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "modeler/triangle_mesh.h"

namespace opal {

/// The solid that loose triangles bound: equal vertices merged, repeated and degenerate triangles dropped, seams stitched, parts
/// that cross one another united, triangles turned to face outward. Which way the triangles faced plays no role: a part inside
/// another, which it does not cross, is a cavity, a part inside that is solid again, and so on. Throws InputError, naming the
/// mesh by `name`, where the surface is open (with the number of border edges and holes and the places of the first ones), where
/// a part intersects itself, and where it bounds no volume.
TriangleMesh solid_from_triangles(const TriangleMesh& soup, const std::string& name);

}  // namespace opal
