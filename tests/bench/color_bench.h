// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace opal {

/// Compares the three ways from colours to spectra, Jakob-Hanika, Smits and the basis, under D65. Errors are dE*ab of 1976.
/// Writes into `folder`:
///  - upsampling_round_trip.csv: error of a colour through its spectrum and back, over 33 values per component, evenly spaced as
///    they are encoded for display, and over those of them whose components are neither 0 nor 1;
///  - upsampling_round_trip_colors.csv: the same, each colour (linear sRGB);
///  - multiplication.csv: the difference between products of colours in RGB and of their spectra, for 1 to 10 multiplications of
///  a
///    colour by itself and by another drawn from the cube, over 17 values per component.
/// Throws SystemError where a file cannot be written.
void bench_color(const std::filesystem::path& folder);

}  // namespace opal
