// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "modeler/triangle_mesh.h"

namespace opal {

/// Reads every triangle of an OBJ, PLY, STL or glTF file, its coordinates times `mm_per_unit`, nodes' transforms applied, nothing
/// merged or repaired. Throws InputError for missing and foreign files and for files without triangles or with broken
/// coordinates.
TriangleMesh read_mesh_file(const std::filesystem::path& file, double mm_per_unit);

/// The points of such a file, those that no triangle uses too, in the file's units. Throws InputError for missing and
/// foreign files.
std::vector<openvdb::Vec3d> read_mesh_vertices(const std::filesystem::path& file);

}  // namespace opal
