// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "modeler/shape.h"
#include "modeler/triangle_mesh.h"

namespace opal {

/// The solid bounded by a mesh file's triangles, its coordinates times `mm_per_unit`. Throws InputError for files that cannot be
/// read and for meshes that are open, whose parts intersect themselves, or that bound no volume (solid_from_triangles).
std::unique_ptr<Shape> make_mesh_shape(const std::filesystem::path& file, double mm_per_unit);

/// The solid bounded by the triangles of `solid_from_triangles`; `exact_surface` is what they approximate, where there is more.
std::unique_ptr<Shape> make_solid_shape(TriangleMesh solid, std::vector<BezierPatch> exact_surface = {});

}  // namespace opal
