// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <filesystem>
#include <vector>

namespace opal {

/// A user's sites, their coordinates times `mm_per_unit`:
/// .csv: x,y,z per line, in full precision, further columns ignored; a first line without numbers is a header; empty lines and
/// lines that begin with # are skipped;
/// .ply: the vertices in the file's order, in single precision, faces ignored;
/// .vdb: the points of the grid `sites`, or else of the first grid of points, by their transform, in the order of their
/// attribute `id` where there is one.
/// Throws InputError, for .csv with file:line, for what cannot be read, coordinates that are not finite, and files without
/// points or with more than 50 million.
std::vector<openvdb::Vec3d> read_site_file(const std::filesystem::path& file, double mm_per_unit);

}  // namespace opal
