// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/scene_view.h"
#include "renderer/host/mesh_data.h"

namespace opal {

/// Whether a closed mesh has a point inside: its winding number there, from the triangles' solid angles (Van Oosterom & Strackee
/// 1983).
bool encloses(const MeshData& mesh, Vec3 point);

/// Whether part of a mesh (world space) may lie deeper in a body than its level set and the triangles made from it can differ:
/// half a voxel. Never false where it does; may be true for a surface that nearly does. False for a body without level set.
bool reaches_inside(const MeshData& mesh, const OpalView& body);

}  // namespace opal
