// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/image.h"

namespace opal {

/// Display picture from a linear sRGB one: exposure (in stops), gamut mapping (spectral colours outside sRGB are drawn towards
/// grey of the same luminance until they fit), a shoulder for highlights that keeps their hue, sRGB encoding. Returns three
/// channels in [0, 1].
Image tone_mapped(const Image& linear, double exposure_ev);

}  // namespace opal
