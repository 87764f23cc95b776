// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>

#include "modeler/shape.h"

namespace opal {

/// The solid bounded by a mesh file's triangles, its coordinates times `mm_per_unit`. Throws InputError for files that cannot be
/// read and meshes that are open, intersect themselves or bound no volume.
std::unique_ptr<Shape> make_mesh_shape(const std::filesystem::path& file, double mm_per_unit);

}  // namespace opal
