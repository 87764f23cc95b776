// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <vector>

namespace opal {

/// Triangles over shared vertices, in mm.
struct TriangleMesh {
    std::vector<openvdb::Vec3d> vertices_mm;
    std::vector<openvdb::Vec3I> triangles;
};

}  // namespace opal
