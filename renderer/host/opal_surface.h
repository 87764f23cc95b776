// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include "renderer/host/mesh_data.h"

namespace opal {

/// The outer surface of an opal as a smooth triangle mesh, from its level set: vertices are moved onto the zero level and carry
/// the level set's gradient as normal, so that a coarse voxel does not show as facets. Throws InputError naming `file` where the
/// level set has no surface.
MeshData surface_from_level_set(const openvdb::FloatGrid& shape, const std::string& file);

}  // namespace opal
