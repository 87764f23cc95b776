// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "formats/image.h"
#include "renderer/optics/crystal_optics.h"

namespace opal {

/// Where the eye sees a single wavelength as a colour; the chart is grey elsewhere.
inline constexpr double chart_visible_min_nm = 380.0, chart_visible_max_nm = 780.0;

/// What the chart of Bragg colours shows.
struct BraggChart {
    CrystalOptics crystal;  ///< but for the diameter
    PlaneFamily planes;
    double diameter_min_nm, diameter_max_nm;  ///< from left to right
    double angle_min_deg, angle_max_deg;      ///< from bottom to top; outside, in air
    std::string title;
};

/// Display-encoded sRGB of a single wavelength. Spectral colours lie outside of the gamut: components below zero are cut, and the
/// strongest is made 1 but at the ends of the spectrum, where the eye's response fades.
std::array<float, 3> spectral_display_color(double wavelength_nm);

/// Every point the colour of its Bragg wavelength, with labelled axes, display-encoded RGB. Throws InputError where the index
/// varies so wildly that there is no Bragg wavelength.
Image draw_bragg_chart(const BraggChart& chart);

}  // namespace opal
