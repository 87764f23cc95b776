// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace opal {

/// Reflectances of white, cyan, magenta, yellow, red, green and blue in ten equal bins from 380 to 720 nm: the table that Smits
/// publishes in "An RGB-to-spectrum conversion for reflectances", Journal of Graphics Tools 4(4), 1999. It is for the primaries of
/// sRGB and an equal-energy white, and its values pass 1 by up to 1.5 %.
inline constexpr int smits_bins = 10;
inline constexpr float smits_min_nm = 380.0f, smits_max_nm = 720.0f;
extern const std::array<std::array<float, smits_bins>, 7> smits_basis;

}  // namespace opal
