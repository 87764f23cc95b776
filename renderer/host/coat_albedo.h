// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "renderer/core/plastic.h"

namespace opal {

/// What a rough coat of relative index `eta` reflects by itself; see Plastic.
struct CoatAlbedo {
    std::array<float, coat_albedo_samples> value = {};
    float mean = 0.0f;
};

/// By stratified sums over the visible normals, good to 1e-3. `roughness` from min_roughness.
CoatAlbedo make_coat_albedo(float roughness, float eta);

}  // namespace opal
