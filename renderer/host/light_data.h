// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "formats/scene.h"
#include "renderer/core/lights.h"

namespace opal {

/// Owns the lights of a scene beside its environment.
class LightData {
  public:
    /// `environment_luminance`: mean over all directions.
    LightData(const std::vector<LightDescription>& descriptions, Upsampling upsampling, float environment_luminance);

    LightsView view() const;
    /// Spectrum (1 nm, Y as the light's share) of what about reaches a point (mm) from these lights, environment excluded.
    std::vector<double> spectrum_at(Vec3 point) const;

  private:
    std::vector<LightView> lights_;
    std::vector<std::vector<float>> radiance_;  ///< of each, 1 nm
    float environment_luminance_;
};

}  // namespace opal
