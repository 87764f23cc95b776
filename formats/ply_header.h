// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace opal {

/// Throws InputError where a .ply has a header that a reader of meshes could not end with: without its end, or stating more
/// elements than the file has bytes. Other files pass.
void require_sound_ply_header(const std::filesystem::path& file);

}  // namespace opal
