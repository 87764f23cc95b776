// SPDX-License-Identifier: Apache-2.0
#include "formats/illuminant.h"

#include <fmt/format.h>

#include <cmath>

#include "formats/error.h"

namespace opal {
namespace {

using Table = std::span<const double, colorimetric_samples>;

template <typename Function>
SampledSpectrum tabulated(const Function& power) {
    SampledSpectrum spectrum;
    for (int i = 0; i < colorimetric_samples; ++i) {
        spectrum.wavelength_nm.push_back(colorimetric_min_nm + i);
        spectrum.value.push_back(power(spectrum.wavelength_nm.back()));
    }
    return spectrum;
}

double standard_a(double wavelength_nm) {
    return 100.0 * std::pow(560.0 / wavelength_nm, 5.0) * std::expm1(1.435e7 / (2848.0 * 560.0)) /
           std::expm1(1.435e7 / (2848.0 * wavelength_nm));
}

double gaussian_band(double wavelength_nm, double peak_nm, double full_width_at_half_maximum_nm) {
    const double t = (wavelength_nm - peak_nm) / full_width_at_half_maximum_nm;
    return std::exp(-4.0 * std::log(2.0) * t * t);
}

/// Solves the 3x3 system whose columns are given, by Cramer's rule.
std::array<double, 3> solve(const std::array<Xyz, 3>& columns, Xyz target) {
    const auto determinant = [](Xyz a, Xyz b, Xyz c) {
        return a.x * (b.y * c.z - b.z * c.y) - b.x * (a.y * c.z - a.z * c.y) + c.x * (a.y * b.z - a.z * b.y);
    };
    const double all = determinant(columns[0], columns[1], columns[2]);
    return {determinant(target, columns[1], columns[2]) / all, determinant(columns[0], target, columns[2]) / all,
            determinant(columns[0], columns[1], target) / all};
}

SampledSpectrum led(double temperature_k) {
    if (!(temperature_k >= led_min_k && temperature_k <= led_max_k))
        throw InputError(fmt::format("an LED of {} K is not possible with its pump and phosphor; allowed: {} to {} K",
                                     temperature_k, led_min_k, led_max_k));
    constexpr double peak_nm[3] = {450.0, 545.0, 630.0}, width_nm[3] = {22.0, 110.0, 90.0};
    std::array<Xyz, 3> bands;
    for (std::size_t i = 0; i < 3; ++i)
        bands[i] = xyz_of(tabulated([&](double w) { return gaussian_band(w, peak_nm[i], width_nm[i]); }));
    const Xyz target = xyz_of(tabulated([&](double w) { return planck_relative_to_560nm(w, temperature_k); }));
    const std::array<double, 3> shares = solve(bands, target);
    return tabulated([&](double w) {
        double power = 0.0;
        for (std::size_t i = 0; i < 3; ++i) power += shares[i] * gaussian_band(w, peak_nm[i], width_nm[i]);
        return power;
    });
}

SampledSpectrum unscaled_illuminant(IlluminantKind kind, double temperature_k, const std::filesystem::path& file) {
    if ((kind == IlluminantKind::blackbody || kind == IlluminantKind::led) && !(temperature_k > 0.0))
        throw InputError(fmt::format("a temperature of {} K is not possible; it must be above 0", temperature_k));
    switch (kind) {
        case IlluminantKind::d65:
            return tabulated(cie_d65_at);
        case IlluminantKind::a:
            return tabulated(standard_a);
        case IlluminantKind::equal_energy:
            return tabulated([](double) { return 1.0; });
        case IlluminantKind::blackbody:
            return tabulated([&](double w) { return planck_relative_to_560nm(w, temperature_k); });
        case IlluminantKind::led:
            return led(temperature_k);
        case IlluminantKind::file:
            break;
    }
    const SampledSpectrum samples = read_spectrum_csv(file);
    return tabulated([&](double w) { return samples.at(w); });
}

}  // namespace

SampledSpectrum illuminant_spectrum(IlluminantKind kind, double temperature_k, const std::filesystem::path& file) {
    SampledSpectrum spectrum = unscaled_illuminant(kind, temperature_k, file);
    const double luminance = xyz_of(spectrum).y;
    if (!(luminance > 0.0) || !std::isfinite(luminance))
        throw InputError(kind == IlluminantKind::file
                             ? fmt::format("{}: no light between 360 and 830 nm that the eye sees", file.string())
                             : fmt::format("a light of {} K has no finite visible power", temperature_k));
    for (double& value : spectrum.value) value /= luminance;
    return spectrum;
}

std::vector<double> colorimetric_table(const SampledSpectrum& spectrum) {
    std::vector<double> table;
    table.reserve(colorimetric_samples);
    for (int i = 0; i < colorimetric_samples; ++i) table.push_back(spectrum.at(colorimetric_min_nm + i));
    return table;
}

Xyz xyz_of(const SampledSpectrum& light) {
    return xyz_of(Table(colorimetric_table(light)));
}

Xyz xyz_of(const SampledSpectrum& reflectance, const SampledSpectrum& light) {
    return xyz_of_product(Table(colorimetric_table(reflectance)), Table(colorimetric_table(light)));
}

}  // namespace opal
