// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The units of the project, in one place. Lengths are millimetres in recipes, scenes and VDB world space; wavelengths and sphere
/// diameters are (vacuum) nanometres; coefficients are per millimetre; angles are degrees in files and radians in code; Z is up.
namespace opal::units {

inline constexpr double metres_per_world_unit = 1.0e-3;
inline constexpr double nm_per_mm = 1.0e6;
inline constexpr double um_per_mm = 1.0e3;
inline constexpr double nm_per_um = 1.0e3;
inline constexpr double pi = 3.14159265358979323846;

/// The wavelengths that paths carry and films record.
inline constexpr double wavelength_min_nm = 360.0;
inline constexpr double wavelength_max_nm = 830.0;

constexpr double rad_from_deg(double angle_deg) {
    return angle_deg * (pi / 180.0);
}
constexpr double deg_from_rad(double angle_rad) {
    return angle_rad * (180.0 / pi);
}

}  // namespace opal::units
