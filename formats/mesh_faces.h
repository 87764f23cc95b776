// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/scene.h>
#include <fmt/format.h>

#include <string>

#include "formats/error.h"

namespace opal {

/// Throws InputError where a mesh as it was read has a face without corners or one that names a vertex that is not there:
/// Assimp's further steps do not come back from either.
inline void require_sound_faces(const aiScene& scene, const std::string& file) {
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[m];
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices == 0) throw InputError(fmt::format("{}: face {} has no corners", file, f + 1));
            for (unsigned k = 0; k < face.mNumIndices; ++k)
                if (face.mIndices[k] >= mesh.mNumVertices)
                    throw InputError(fmt::format("{}: face {} names a vertex that is not there", file, f + 1));
        }
    }
}

}  // namespace opal
