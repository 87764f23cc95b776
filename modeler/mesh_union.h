// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "modeler/cgal_surface.h"

namespace opal {

/// Replaces the connected parts of a closed surface that cross one another by their union; parts that cross nothing stay. Each
/// part of a crossing is taken as a solid of its own, whichever way its triangles face. Throws InputError, naming the mesh by
/// `name`, where a part crosses itself or a union is not a surface (parts that only touch along an edge).
void unite_crossing_parts(cgal::Surface& surface, const std::string& name);

}  // namespace opal
