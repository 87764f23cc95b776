// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <filesystem>
#include <string>

namespace opal {

/// The float grid of a user's .vdb: the one called `name`, or the file's only one where `name` is empty. Throws InputError naming
/// file and grids where there is no such grid or no choice between several.
openvdb::FloatGrid::Ptr read_float_grid(const std::filesystem::path& file, const std::string& name);

/// Value at a place in the grid's world space, taken as millimetres, interpolated linearly. `file` is named in the InputError
/// that a value which is not finite throws.
double sample_float_grid(const openvdb::FloatGrid& grid, const openvdb::Vec3d& place_mm, const std::filesystem::path& file);

}  // namespace opal
