// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/mesh_file.h"

#include <fmt/format.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>
#include <cmath>

#include "formats/error.h"
#include "formats/ply_header.h"
#include "renderer/host/mesh_topology.h"

namespace opal {
namespace {

Vec3 checked(const aiVector3D& p, unsigned vertex, const std::filesystem::path& path) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        throw InputError(fmt::format("{}: vertex {} is not finite", path.string(), vertex));
    return {p.x, p.y, p.z};
}

void add_part(const aiMesh& part, bool with_normals, const std::filesystem::path& path, MeshData& mesh) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
        mesh.positions.push_back(checked(part.mVertices[v], v, path));
        if (!with_normals) continue;
        const aiVector3D& n = part.mNormals[v];
        const Vec3 normal{n.x, n.y, n.z};
        const float size = length(normal);
        if (!(size > 0.0f) || !std::isfinite(size))
            throw InputError(fmt::format("{}: the normal of vertex {} is no direction; smooth_normals_deg computes normals",
                                         path.string(), v));
        mesh.normals.push_back((1.0f / size) * normal);
    }
    for (unsigned f = 0; f < part.mNumFaces; ++f)
        for (unsigned k = 0; k < 3; ++k) mesh.indices.push_back(base + part.mFaces[f].mIndices[k]);
}

}  // namespace

MeshData load_mesh(const std::filesystem::path& path, std::optional<double> smooth_normals_deg,
                   std::vector<std::string>& notices) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) throw InputError(fmt::format("{}: no such mesh file", path.string()));
    require_sound_ply_header(path);
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path.string(), aiProcess_ValidateDataStructure | aiProcess_Triangulate |
                                                                aiProcess_JoinIdenticalVertices | aiProcess_SortByPType |
                                                                aiProcess_PreTransformVertices | aiProcess_FindDegenerates);
    if (!scene) throw InputError(fmt::format("{}: not a readable mesh: {}", path.string(), importer.GetErrorString()));
    std::vector<const aiMesh*> parts;
    unsigned most_material = 0, least_material = ~0u;
    // Those of a .stl are its facets', often left 0; the triangles have them anyway.
    bool with_normals = !smooth_normals_deg && path.extension() != ".stl" && path.extension() != ".STL";
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        const aiMesh& part = *scene->mMeshes[m];
        if ((part.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0) continue;
        parts.push_back(&part);
        most_material = std::max(most_material, part.mMaterialIndex);
        least_material = std::min(least_material, part.mMaterialIndex);
        with_normals = with_normals && part.HasNormals();
    }
    if (parts.empty()) throw InputError(fmt::format("{}: holds no triangles", path.string()));
    MeshData mesh;
    for (const aiMesh* part : parts) add_part(*part, with_normals, path, mesh);
    if (most_material > least_material)
        notices.push_back(
            fmt::format("{}: its groups have materials of their own; the object's material covers them all", path.string()));
    if (smooth_normals_deg) add_crease_normals(mesh, *smooth_normals_deg);
    return mesh;
}

}  // namespace opal
