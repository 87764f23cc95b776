// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "formats/scene.h"
#include "renderer/core/upsampling.h"

namespace opal {

UpsamplingMethod upsampling_method(Upsampling upsampling);

/// Coefficients of the sigmoid reflectance of a linear sRGB colour in [0, 1], by trilinear interpolation in sigmoid_table().
/// Greys are constant and exact.
std::array<float, 3> sigmoid_coefficients(Rgb color);

/// Spectrum of a reflectance, linear sRGB in [0, 1].
UpsampledColor upsample_reflectance(UpsamplingMethod method, Rgb color);

/// Spectrum of a radiance over that of the light, any linear sRGB of at least 0: the reflectance of the colour over twice its
/// largest component, so that no spectrum has to be extreme, times that (Jakob & Hanika 2019, section 5.1).
UpsampledColor upsample_radiance(UpsamplingMethod method, Rgb color);

}  // namespace opal
