// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

namespace opal {

/// Samples of a colorimetric table: 360 to 830 nm in steps of 1 nm, the range of the CIE 1931 2-degree observer.
inline constexpr int colorimetric_samples = 471;
inline constexpr double colorimetric_min_nm = 360.0;

/// CIE 1931 tristimulus values, 1 for a spectrum that is 1 at every wavelength (divided by the integral of y).
struct Xyz {
    double x, y, z;
};

/// Linear sRGB (IEC 61966-2-1), out of gamut where a component is negative.
struct Rgb3d {
    double r, g, b;
};

struct Chromaticity {
    double x, y;
};

/// CIE 1976 L*a*b*.
struct Lab {
    double l, a, b;
};

using Matrix3 = std::array<std::array<double, 3>, 3>;

/// CIE standard illuminant D65, 100 at 560 nm: linear between the standard's values every 5 nm. 300 to 830 nm.
double cie_d65_at(double wavelength_nm);

/// Integral of the CIE 1931 y over the wavelength, nm: the sum of its values in steps of 1 nm.
double luminosity_integral_nm();

/// Tristimulus values of a spectrum in steps of 1 nm: sums of spectrum times observer over the sum of y (CIE 015, 1 nm
/// summation).
Xyz xyz_of(std::span<const double, colorimetric_samples> spectrum);

/// Tristimulus values of the product of two spectra, such as a reflectance and a light.
Xyz xyz_of_product(std::span<const double, colorimetric_samples> first, std::span<const double, colorimetric_samples> second);

Chromaticity chromaticity_of(Xyz color);

/// XYZ of linear sRGB and back. The white, RGB (1, 1, 1), is D65 as this project integrates it, XYZ (0.9504707, 1, 1.0888285).
Rgb3d linear_srgb_from_xyz(Xyz color);
Xyz xyz_from_linear_srgb(Rgb3d color);
inline constexpr Xyz srgb_white = {0.9504707, 1.0, 1.0888285};

/// Encodes a linear component for display (IEC 61966-2-1).
double srgb_encoded(double linear);
/// The linear component of an encoded one.
double srgb_decoded(double encoded);

/// Chromatic adaptation of XYZ from one white to another: von Kries scaling of the cone responses of Lam and Rigg's Bradford
/// matrix ("linear Bradford", as in ICC.1:2022 annex E). `from` becomes `to` exactly.
Matrix3 bradford_adaptation(Xyz from, Xyz to);
Xyz operator*(const Matrix3& matrix, Xyz color);

/// CIE 1976 L*a*b* relative to a white (CIE 015), and the colour difference dE*ab, the distance in it.
Lab lab_from_xyz(Xyz color, Xyz white);
double delta_e_76(const Lab& a, const Lab& b);

/// Colour difference CIEDE2000 (CIE 142-2001; ISO/CIE 11664-6), parametric factors 1, in the form of Sharma, Wu and Dalal,
/// "The CIEDE2000 color-difference formula: implementation notes", Color Research and Application 30 (2005). About 1 is just
/// noticeable side by side.
double delta_e_2000(const Lab& a, const Lab& b);

/// Correlated colour temperature (K) and distance from the Planckian locus in CIE 1960 (u, v), positive above the locus
/// (CIE 015; ANSI C78.377): the nearest point of the locus, from 800 K to 100,000 K, by golden-section search over 1 / T.
struct CorrelatedColorTemperature {
    double temperature_k;
    double duv;
};
CorrelatedColorTemperature correlated_color_temperature(Chromaticity chromaticity);

/// Planck's spectral radiance of a black body in vacuum relative to that at 560 nm; c2 = 0.01438776877 m K (CODATA 2018).
double planck_relative_to_560nm(double wavelength_nm, double temperature_k);

}  // namespace opal
