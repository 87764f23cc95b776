// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "formats/scene.h"
#include "renderer/core/environment.h"

namespace opal {

/// Owns the environment: its picture and the tables that draw directions from it.
struct EnvironmentMap {
    int width = 0, height = 0;
    double rotation_rad = 0.0;
    float mean_luminance = 0.0f;  ///< over all directions
    std::vector<UpsampledColor> texels;
    std::vector<float> row_cdf, column_cdf;

    EnvironmentView view() const {
        return {texels.data(), row_cdf.data(), column_cdf.data(), width, height, float(rotation_rad)};
    }
};

/// Loads or builds the environment of a scene: a constant, the built-in studio or light tent, or a latitude-longitude file (.exr,
/// .hdr); its colours become spectra by `upsampling`. Negative texels count as 0, with a notice. Throws InputError for unreadable
/// files, for texels that are no finite numbers, and where what is negative amounts to more than a hundredth of the light, naming
/// the texel.
EnvironmentMap make_environment(const EnvironmentDescription& description, Upsampling upsampling = Upsampling::jakob_hanika,
                                std::vector<std::string>* notices = nullptr);

/// Radiance of the built-in studio from a unit direction (Z up, camera in front at -Y): a large key soft box at the upper left, a
/// strip at the right, a low fill from the front and a rim light behind, in a dim surround. Linear sRGB times the illuminant.
Rgb studio_radiance(Vec3 direction);

/// Radiance of the built-in light tent: white cloth all around, brighter above than below, lit by one lamp through the cloth at
/// the upper left, so broadly that pictures of opals need tens of times fewer samples than in the studio. Linear sRGB times the
/// illuminant.
Rgb tent_radiance(Vec3 direction);

}  // namespace opal
