// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/compat.h"

namespace opal {

/// Distance to the next event in a medium of constant coefficient, by inversion of 1 - exp(-sigma t); beyond every scene where
/// the coefficient is 0.
OPAL_HD inline float sample_free_flight_mm(float u, float sigma_per_mm) {
    return sigma_per_mm > 0.0f ? -logf(1.0f - u) / sigma_per_mm : 3.0e38f;
}

}  // namespace opal
