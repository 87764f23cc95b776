// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "formats/illuminant.h"
#include "renderer/core/spectrum_view.h"
#include "renderer/host/alias_table_data.h"

namespace opal {

/// Owns the wavelength tables of a render.
struct SpectrumTablesData {
    std::vector<Vec3> observer;
    std::vector<float> white;
    std::vector<Vec3> rgb_basis;
    std::vector<float> pdf;
    std::vector<float> cdf;
    std::vector<SmitsRow> smits;
    UpsamplingMethod upsampling = UpsamplingMethod::sigmoid;
    AliasTableData alias;  ///< empty: wavelengths are drawn by inversion

    SpectrumTables view() const {
        return {observer.data(), white.data(), rgb_basis.data(), pdf.data(), cdf.data(), smits.data(), upsampling, alias.view()};
    }
};

struct SpectrumTableOptions {
    SampledSpectrum illuminant = illuminant_spectrum(IlluminantKind::d65);  ///< scaled so that Y = 1
    Upsampling upsampling = Upsampling::jakob_hanika;
    std::vector<double> drawn_light;  ///< 1 nm: the light that wavelengths are drawn for; empty: the illuminant
    bool alias = false;               ///< wavelengths by an alias table: for independent random numbers
};

/// CIE 1931 observer over its integral of y, the illuminant, the spectra that colours are made of, and a density of wavelengths
/// that follows what a display shows of the light: nine tenths proportional to light times (x + y + z), one tenth uniform so
/// that every wavelength is drawn.
SpectrumTablesData make_spectrum_tables(const SpectrumTableOptions& options = {});

}  // namespace opal
