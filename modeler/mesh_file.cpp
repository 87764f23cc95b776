// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>

#include "formats/error.h"
#include "formats/ply_header.h"
#include "formats/text.h"

namespace opal {
namespace {

const std::vector<std::string> readable_extensions = {".obj", ".ply", ".stl", ".gltf", ".glb"};

void require_readable(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
    if (std::find(readable_extensions.begin(), readable_extensions.end(), extension) == readable_extensions.end())
        throw InputError(
            fmt::format("mesh {}: not a kind of file that can be read ({})", file.string(), join(readable_extensions)));
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) throw InputError(fmt::format("mesh {}: no such file", file.string()));
}

void append(const aiMesh& part, double mm_per_unit, const std::filesystem::path& file, TriangleMesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices_mm.size());
    for (unsigned n = 0; n < part.mNumVertices; ++n) {
        const aiVector3D& v = part.mVertices[n];
        const openvdb::Vec3d vertex_mm = openvdb::Vec3d(v.x, v.y, v.z) * mm_per_unit;
        if (!vertex_mm.isFinite())
            throw InputError(fmt::format("mesh {}: vertex {} is not a finite number", file.string(), n + 1));
        mesh.vertices_mm.push_back(vertex_mm);
    }
    for (unsigned n = 0; n < part.mNumFaces; ++n) {
        const aiFace& face = part.mFaces[n];
        if (face.mNumIndices != 3) continue;
        for (unsigned corner = 0; corner < 3; ++corner)
            if (face.mIndices[corner] >= part.mNumVertices)
                throw InputError(fmt::format("mesh {}: face {} names a vertex that is not there", file.string(), n + 1));
        mesh.triangles.emplace_back(first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]);
    }
}

const aiScene& read_scene(Assimp::Importer& importer, const std::filesystem::path& file, unsigned steps) {
    require_readable(file);
    require_sound_ply_header(file);
    const aiScene* const scene = importer.ReadFile(file.string(), steps);
    if (scene == nullptr) {
        const std::string reason = importer.GetErrorString();
        throw InputError(fmt::format("mesh {}: cannot be read: {}", file.string(), reason.empty() ? "unknown content" : reason));
    }
    return *scene;
}

}  // namespace

TriangleMesh read_mesh_file(const std::filesystem::path& file, double mm_per_unit) {
    Assimp::Importer importer;
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const aiScene& scene = read_scene(
        importer, file,
        aiProcess_ValidateDataStructure | aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_SortByPType);
    TriangleMesh mesh;
    for (unsigned n = 0; n < scene.mNumMeshes; ++n) append(*scene.mMeshes[n], mm_per_unit, file, mesh);
    if (mesh.triangles.empty()) throw InputError(fmt::format("mesh {}: holds no triangles", file.string()));
    return mesh;
}

std::vector<openvdb::Vec3d> read_mesh_vertices(const std::filesystem::path& file) {
    Assimp::Importer importer;
    const aiScene& scene = read_scene(importer, file, 0);
    std::vector<openvdb::Vec3d> vertices;
    for (unsigned n = 0; n < scene.mNumMeshes; ++n)
        for (unsigned k = 0; k < scene.mMeshes[n]->mNumVertices; ++k) {
            const aiVector3D& v = scene.mMeshes[n]->mVertices[k];
            vertices.emplace_back(v.x, v.y, v.z);
        }
    return vertices;
}

}  // namespace opal
