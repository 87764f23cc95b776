// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/upsampling.h"

namespace opal {

enum class MaterialModel { diffuse };

/// What covers an opaque surface.
struct MaterialView {
    MaterialModel model = MaterialModel::diffuse;
    UpsampledColor albedo;
};

}  // namespace opal
