// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace opal {

/// Colour matching functions at one wavelength.
struct CieObserverRow {
    float x, y, z;
};

/// CIE 1931 2-degree standard observer, 360 to 830 nm in steps of 1 nm (CIE 015; ISO/CIE 11664-1).
extern const std::array<CieObserverRow, 471> cie_1931_observer;

/// CIE standard illuminant D65, 300 to 830 nm in steps of 5 nm, 100 at 560 nm (CIE 015; ISO/CIE 11664-2).
extern const std::array<float, 107> cie_d65_5nm;

}  // namespace opal
