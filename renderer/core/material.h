// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/plastic.h"
#include "renderer/core/upsampling.h"

namespace opal {

enum class MaterialModel { diffuse, conductor, plastic };

/// What covers an opaque surface.
struct MaterialView {
    MaterialModel model = MaterialModel::diffuse;
    UpsampledColor albedo;              ///< diffuse; plastic: of the base; conductor: its colour, for pictures of the albedo
    real roughness = 0.0f;              ///< conductor, plastic: GGX alpha; below min_roughness: smooth
    const float* index = nullptr;       ///< conductor; plastic: of the coat; 1 nm table
    const float* extinction = nullptr;  ///< conductor: imaginary part of the index; 1 nm table
    CoatAlbedoView coat_albedo;         ///< plastic with a rough coat
};

}  // namespace opal
