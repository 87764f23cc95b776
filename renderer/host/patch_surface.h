// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "formats/bezier_patch.h"
#include "renderer/host/mesh_data.h"

namespace opal {

/// The exact surface of a body of Bezier patches, in world space: one closed mesh per part, whose triangles lead rays to the
/// patches. Together the parts cover the body; inside it they overlap.
std::vector<MeshData> surfaces_from_patches(const std::vector<BezierPatch>& patches, const RigidTransform& world_from_object);

}  // namespace opal
