// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/image.h"
#include "formats/scene.h"

namespace opal {

/// Display picture from a linear sRGB one (its channels R, G and B): exposure (in stops), gamut mapping (spectral colours outside
/// sRGB are drawn towards grey of the same luminance until they fit), then by `tone`: a shoulder for highlights that keeps their
/// hue and sRGB encoding; sRGB encoding alone; or neither. Returns three channels in [0, 1].
Image tone_mapped(const Image& linear, double exposure_ev, ToneCurve tone = ToneCurve::filmic);

}  // namespace opal
