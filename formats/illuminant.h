// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "formats/colorimetry.h"
#include "formats/scene.h"
#include "formats/spectrum.h"

namespace opal {

/// Colour temperatures that an LED of `IlluminantKind::led` can have: outside, a share of its bands would be negative.
inline constexpr double led_min_k = 1500.0, led_max_k = 25000.0;

/// Relative spectral power of a light, 360 to 830 nm in steps of 1 nm, scaled so that Y = 1 (see xyz_of):
///  - d65: CIE standard illuminant D65, linear between the standard's values every 5 nm (CIE 015; ISO/CIE 11664-2).
///  - a: CIE standard illuminant A by its defining equation, 100 (560/L)^5 (exp(1.435e7/(2848 560)) - 1) /
///    (exp(1.435e7/(2848 L)) - 1), L in nm (ISO/CIE 11664-2).
///  - equal_energy: 1.
///  - blackbody: Planck's law at `temperature_k`.
///  - led: our own model of a phosphor-converted white LED: a pump band at 450 nm (full width at half maximum 22 nm) and a
///  phosphor
///    of two bands, 545 nm (110 nm) and 630 nm (90 nm), each a Gaussian; their three shares solve three linear equations, XYZ
///    equal to that of the blackbody at `temperature_k`. So the correlated colour temperature is exact and Duv is 0.
///  - file: a .csv of wavelength_nm and relative power, linear between its samples, constant beyond their ends.
/// Throws InputError for a temperature that is not positive or, for led, outside led_min_k to led_max_k; for a .csv as
/// read_spectrum_csv does, and where it gives no light that the eye sees.
SampledSpectrum illuminant_spectrum(IlluminantKind kind, double temperature_k = 0.0, const std::filesystem::path& file = {});

/// A spectrum at 360, 361 ... 830 nm, for colorimetry.
std::vector<double> colorimetric_table(const SampledSpectrum& spectrum);

/// Tristimulus values of a light, and of a light times a reflectance.
Xyz xyz_of(const SampledSpectrum& light);
Xyz xyz_of(const SampledSpectrum& reflectance, const SampledSpectrum& light);

}  // namespace opal
