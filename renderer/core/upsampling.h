// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/spectrum_view.h"

/// Spectra of colours: linear sRGB in the scene, a reflectance (or, times the light, a radiance) at each wavelength in the
/// transport.
namespace opal {

/// Linear sRGB as a spectrum: `scale` times a reflectance in [0, 1], which `value` gives: coefficients of a sigmoid for
/// UpsamplingMethod::sigmoid, else linear sRGB itself.
struct UpsampledColor {
    float value[3] = {0.0f, 0.0f, 0.0f};
    float scale = 0.0f;
};

/// Sigmoid of a polynomial of second order (Jakob & Hanika 2019, equations 1 and 6), its variable the wavelength on [0, 1] from
/// 360 to 830 nm.
OPAL_HD inline real sigmoid_reflectance(const float* coefficients, real wavelength_nm) {
    const real t = (wavelength_nm - spectrum_min_nm) * (1.0f / (spectrum_max_nm - spectrum_min_nm));
    const real x = (coefficients[0] * t + coefficients[1]) * t + coefficients[2];
    return 0.5f + 0.5f * x / sqrt(1.0f + x * x);
}

/// Smits 1999: the smallest component as white, what the middle one has more as the secondary colour of the two larger, and what
/// the largest has more still as its primary. Cut to [0, 1], since some of his spectra pass 1.
OPAL_HD inline real smits_reflectance(const SmitsRow& row, const float* rgb) {
    const int smallest = rgb[0] <= rgb[1] ? (rgb[0] <= rgb[2] ? 0 : 2) : (rgb[1] <= rgb[2] ? 1 : 2);
    const int a = (smallest + 1) % 3, b = (smallest + 2) % 3;
    const int largest = rgb[a] >= rgb[b] ? a : b, middle = a + b - largest;
    const real value = rgb[smallest] * row.white + (rgb[middle] - rgb[smallest]) * row.secondary[smallest] +
                       (rgb[largest] - rgb[middle]) * row.primary[largest];
    return min_of(1.0f, max_of(0.0f, value));
}

OPAL_HD inline const SmitsRow& smits_row_at(const SpectrumTables& tables, real wavelength_nm) {
    const real position = (wavelength_nm - smits_first_nm) * (1.0f / smits_bin_nm);
    return tables.smits[max_of(0, min_of(smits_rows - 1, int(position)))];
}

/// The spectrum of a colour at one wavelength.
OPAL_HD inline real upsampled(const SpectrumTables& tables, const UpsampledColor& color, real wavelength_nm) {
    switch (tables.upsampling) {
        case UpsamplingMethod::sigmoid:
            return color.scale * sigmoid_reflectance(color.value, wavelength_nm);
        case UpsamplingMethod::smits:
            return color.scale * smits_reflectance(smits_row_at(tables, wavelength_nm), color.value);
        case UpsamplingMethod::basis:
            break;
    }
    return color.scale * rgb_spectrum(tables, {color.value[0], color.value[1], color.value[2]}, wavelength_nm);
}

}  // namespace opal
