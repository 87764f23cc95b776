// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "renderer/core/spectrum_view.h"

namespace opal {

/// Owns the wavelength tables of a render.
struct SpectrumTablesData {
    std::vector<Vec3> observer;
    std::vector<float> white;
    std::vector<Vec3> rgb_basis;
    std::vector<float> pdf;
    std::vector<float> cdf;

    SpectrumTables view() const { return {observer.data(), white.data(), rgb_basis.data(), pdf.data(), cdf.data()}; }
};

/// CIE 1931 observer over its integral of y, D65 with Y = 1, the RGB basis, and a density of wavelengths that follows what a
/// display shows of white light: nine tenths proportional to D65 (x + y + z), one tenth uniform so that every wavelength is
/// drawn.
SpectrumTablesData make_spectrum_tables();

}  // namespace opal
