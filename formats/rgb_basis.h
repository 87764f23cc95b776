// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace opal {

/// Reflectance spectra of the three linear sRGB primaries at 360, 370 ... 830 nm, linear between. They lie in [0, 1], sum to 1 at
/// every wavelength, and under D65 give back exactly the RGB they stand for, so that r R + g G + b B is an exact, linear and
/// energy-conserving upsampling of any linear sRGB colour in gamut. Computed by generate_rgb_basis.py.
extern const std::array<std::array<float, 48>, 3> rgb_basis_10nm;

}  // namespace opal
