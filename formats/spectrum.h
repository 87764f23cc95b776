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

/// The shape of a built-in absorber, 1 at 550 nm, sampled every 10 nm (the first two) or 5 nm from 360 to 830 nm.
///  - "carbon": a neutral grey with the gentle slope of small soot particles, absorption proportional to 1/wavelength
///    (Angstrom exponent 1: Bohren & Huffman 1983, section 5.7, absorption of spheres small against the wavelength).
///  - "neutral": the same at every wavelength.
///  - "iron-oxide": hematite particles, small against the wavelength, thinly spread in silica, absorbing as such spheres do
///    (Bohren & Huffman, section 5.2): the orange red of fire opal.
///  - "light-blue-dye": the visible bands of methylene blue, strongest at 655 nm, 17 times its value at 550 nm.
///  - "pink-dye": the visible bands of rhodamine B, strongest at 545 nm, without its fluorescence.
/// The last three are sums of Gaussian bands over the wavenumber; fit_absorbers.py says how they came about and how well they
/// fit. Throws InputError for other names.
SampledSpectrum builtin_absorber(const std::string& name);

/// Two columns, wavelength_nm and value; '#' starts a comment, one header line is allowed. Throws InputError with file:line for
/// missing files, wrong numbers, negative values and wavelengths that do not increase.
SampledSpectrum read_spectrum_csv(const std::filesystem::path& path);

/// The spectrum every 5 nm from 360 to 830 nm, by the monotone cubic spline of Fritsch and Butland, "A method for constructing
/// local monotone piecewise cubic interpolants", SIAM J. Sci. Stat. Comput. 5, 1984: it never leaves the range of the two samples
/// around it, so nothing falls below zero. Constant beyond the samples' ends; linear for fewer than four samples.
SampledSpectrum resample_spectrum(const SampledSpectrum& spectrum);

/// A built-in name or the path of a .csv (resampled), scaled to `value_at_reference` at the wavelength `reference_nm`. Throws
/// InputError for a spectrum with less than 1 % of its strongest there: it has to be scaled at another wavelength.
SampledSpectrum absorber_spectrum(const std::string& name_or_path, double value_at_reference, double reference_nm = 550.0);

/// "360:0.1 370:0.2 ...", the form in which a spectrum travels in .vdb metadata, and back.
std::string spectrum_to_text(const SampledSpectrum& spectrum);
SampledSpectrum spectrum_from_text(const std::string& text);

}  // namespace opal
