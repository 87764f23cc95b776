// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/spectrum_tables.h"

#include "formats/cie_tables.h"
#include "formats/colorimetry.h"
#include "formats/rgb_basis.h"
#include "formats/smits_basis.h"
#include "renderer/host/upsampler.h"

namespace opal {
namespace {

static_assert(spectrum_samples == colorimetric_samples && smits_rows == smits_bins && smits_first_nm == smits_min_nm);

float basis_at(int primary, int index_1nm) {
    const int i = std::min(index_1nm / 10, 46);
    const float t = float(index_1nm - 10 * i) / 10.0f;
    return (1.0f - t) * rgb_basis_10nm[primary][i] + t * rgb_basis_10nm[primary][i + 1];
}

SmitsRow smits_row(std::size_t bin) {
    // Cyan lacks red, magenta green, yellow blue.
    const auto value = [&](std::size_t spectrum) { return smits_basis[spectrum][bin]; };
    return {value(0), {value(1), value(2), value(3)}, {value(4), value(5), value(6)}};
}

/// The density of wavelengths and its integral. The density is what the rounded integral draws, so that inversion and density
/// agree to the last digit.
void add_wavelength_density(const std::vector<double>& light, SpectrumTablesData& tables) {
    std::vector<double> density;
    double total = 0.0;
    for (std::size_t i = 0; i + 1 < spectrum_samples; ++i) {
        const auto at = [&](std::size_t k) {
            const Vec3 observer = tables.observer[k];
            return double(observer.x + observer.y + observer.z) * light[k];
        };
        density.push_back(0.5 * (at(i) + at(i + 1)));
        total += density.back();
    }
    tables.cdf.push_back(0.0f);
    double sum = 0.0;
    for (const double value : density) {
        sum += 0.9 * value / total + 0.1 / double(spectrum_samples - 1);
        tables.cdf.push_back(float(sum));
    }
    tables.cdf.back() = 1.0f;
    for (std::size_t i = 0; i + 1 < spectrum_samples; ++i) tables.pdf.push_back(tables.cdf[i + 1] - tables.cdf[i]);
}

}  // namespace

SpectrumTablesData make_spectrum_tables(const SpectrumTableOptions& options) {
    SpectrumTablesData tables;
    const std::vector<double> light = colorimetric_table(options.illuminant);
    const float scale = float(1.0 / luminosity_integral_nm());
    for (int i = 0; i < spectrum_samples; ++i) {
        const CieObserverRow& row = cie_1931_observer[std::size_t(i)];
        tables.observer.push_back({row.x * scale, row.y * scale, row.z * scale});
        tables.white.push_back(float(light[std::size_t(i)]));
        tables.rgb_basis.push_back({basis_at(0, i), basis_at(1, i), basis_at(2, i)});
    }
    for (std::size_t bin = 0; bin < smits_bins; ++bin) tables.smits.push_back(smits_row(bin));
    tables.upsampling = upsampling_method(options.upsampling);
    add_wavelength_density(options.drawn_light.empty() ? light : options.drawn_light, tables);
    if (options.alias) tables.alias = make_alias_table(tables.pdf);
    return tables;
}

}  // namespace opal
