// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "formats/scene.h"
#include "renderer/core/scene_view.h"

namespace opal {

/// Owns a triangle mesh; `normals` is empty where faces are flat.
struct MeshData {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;
    std::vector<std::uint32_t> indices;
    int material = -1;
    int body = -1;
    std::vector<BezierPatch> patches;  ///< world space: the surface itself, the triangles are near it; empty where they are it
    std::vector<PatchPiece> pieces;    ///< of the patches
    float deviation_mm = 0.0f;         ///< how far the triangles may be from the surface

    MeshView view() const {
        return {positions.data(),
                normals.empty() ? nullptr : normals.data(),
                indices.data(),
                std::uint32_t(positions.size()),
                std::uint32_t(indices.size() / 3),
                material,
                body,
                patch_view()};
    }
    PatchMeshView patch_view() const {
        return {patches.empty() ? nullptr : patches.data(), pieces.data(), std::uint32_t(patches.size()),
                std::uint32_t(pieces.size())};
    }
};

/// A square of edge `size_mm` at z = 0, facing up.
MeshData make_plane(double size_mm);
/// A sphere about the origin.
MeshData make_sphere(double radius_mm);
/// A solid of revolution about Z whose flat top lies at z = 0, rounded at its upper edge: something to stand a gem on.
MeshData make_cylinder(double radius_mm, double height_mm, double bevel_mm);

/// Rotation about X, then Y, then Z, uniform scale, translation.
RigidTransform object_transform(const ObjectDescription& object);

/// Applies a transform in place.
void transform_mesh(MeshData& mesh, const RigidTransform& world_from_object);

}  // namespace opal
