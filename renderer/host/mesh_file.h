// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "renderer/host/mesh_data.h"

namespace opal {

/// A file that Assimp reads (OBJ, PLY, STL, glTF), coordinates taken as mm. Normals are the file's own where it has them; with
/// `smooth_normals_deg` they are computed (crease_normals). All groups become one mesh; where the file names several materials a
/// line is appended to `notices`. Throws InputError.
MeshData load_mesh(const std::filesystem::path& path, std::optional<double> smooth_normals_deg,
                   std::vector<std::string>& notices);

}  // namespace opal
