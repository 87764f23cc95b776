// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
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

    MeshView view() const {
        return {positions.data(), normals.empty() ? nullptr : normals.data(), indices.data(), material, body};
    }
};

/// A square of edge `size_mm` at z = 0, facing up.
MeshData make_plane(double size_mm);
/// A sphere about the origin.
MeshData make_sphere(double radius_mm);
/// A solid of revolution about Z whose flat top lies at z = 0, rounded at its upper edge: something to stand a gem on.
MeshData make_cylinder(double radius_mm, double height_mm, double bevel_mm);
/// A file that Assimp reads (OBJ, PLY, STL, glTF), in mm. Throws InputError.
MeshData load_mesh(const std::filesystem::path& path);

/// Rotation about X, then Y, then Z, uniform scale, translation.
RigidTransform object_transform(const ObjectDescription& object);

/// Applies a transform in place.
void transform_mesh(MeshData& mesh, const RigidTransform& world_from_object);

}  // namespace opal
