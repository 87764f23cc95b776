// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace opal {

/// A tabulated function of the vacuum wavelength: linear between samples, constant beyond the ends.
struct SampledSpectrum {
    std::vector<double> wavelength_nm;  ///< strictly increasing
    std::vector<double> value;

    double at(double wavelength) const;
};

/// Names of the built-in absorbers.
const std::vector<std::string>& builtin_absorbers();

/// The shape of a built-in absorber, 1 at 550 nm, sampled every 10 nm over the visible range.
///  - "carbon": a neutral grey with the gentle slope of small soot particles, absorption proportional to 1/wavelength
///    (Angstrom exponent 1: Bohren & Huffman 1983, section 5.7, absorption of spheres small against the wavelength).
///  - "neutral": the same at every wavelength.
/// Throws InputError for other names.
SampledSpectrum builtin_absorber(const std::string& name);

/// Two columns, wavelength_nm and value; '#' starts a comment, one header line is allowed. Throws InputError with file:line for
/// missing files, wrong numbers, negative values and wavelengths that do not increase.
SampledSpectrum read_spectrum_csv(const std::filesystem::path& path);

/// A built-in name or the path of a .csv, scaled to `value_at_550nm`. A spectrum that is zero at 550 nm cannot be scaled:
/// InputError.
SampledSpectrum absorber_spectrum(const std::string& name_or_path, double value_at_550nm);

/// "360:0.1 370:0.2 ...", the form in which a spectrum travels in .vdb metadata, and back.
std::string spectrum_to_text(const SampledSpectrum& spectrum);
SampledSpectrum spectrum_from_text(const std::string& text);

}  // namespace opal
