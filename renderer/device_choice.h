// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "renderer/cpu/render_picture.h"

namespace opal {

/// What draws the samples, and why.
struct DeviceChoice {
    bool cuda = false;
    std::string reason;  ///< for people
};

/// `asked`: auto, cpu or cuda; auto is the processor so far. Throws InputError where cuda is asked for and cannot be had.
DeviceChoice choose_device(const std::string& asked);

/// Nothing for the processor. `meshes`: of the scene; they must outlive the render.
MakeDevice device_maker(const DeviceChoice& choice, const std::vector<MeshData>& meshes);

}  // namespace opal
