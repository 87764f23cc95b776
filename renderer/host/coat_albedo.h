// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "renderer/core/plastic.h"

namespace opal {

/// What a rough coat reflects by itself against everything that may be before it; see Plastic.
struct CoatAlbedo {
    std::vector<float> eta, value, mean;

    CoatAlbedoView view() const { return {eta.data(), value.data(), mean.data(), int(eta.size())}; }
};

/// Indices of the coat relative to one medium before it: least and most over the wavelengths.
struct EtaRange {
    float least = 1.0f, most = 1.0f;
};

/// For the indices that occur, from min_roughness: by stratified sums over the visible normals, good to 1e-3.
CoatAlbedo make_coat_albedo(float roughness, std::span<const EtaRange> ranges);

}  // namespace opal
