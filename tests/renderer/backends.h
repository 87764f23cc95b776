// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "renderer/cpu/render_picture.h"

/// What draws a test's pictures: "cpu", the processor with Embree; "loop", what the threads of a device do as a loop on the
/// processor; "cuda", the CUDA devices that are visible.
namespace opal {

/// Why a backend cannot be had here; empty where it can.
std::string missing_backend(const std::string& backend);

/// Nothing for "cpu". `meshes`: of the scene; they must outlive the render.
MakeDevice backend_maker(const std::string& backend, const std::vector<MeshData>& meshes);

}  // namespace opal
