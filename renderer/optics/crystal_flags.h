// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "renderer/optics/crystal_optics.h"

namespace opal {

/// The flags that name a crystal, or a sphere, as they were typed.
struct CrystalFlags {
    std::string sphere_diameter_nm = "250";
    std::string n_sphere = "1.45", n_medium = "1.333";
    std::string hkl = "1,1,1";
    std::string filling, index_mean = "linear";
};

/// Adds --sphere-diameter-nm, --n-sphere and --n-medium.
void add_sphere_flags(CLI::App& command, CrystalFlags& flags);
/// Adds those and --hkl, --filling and --index-mean.
void add_crystal_flags(CLI::App& command, CrystalFlags& flags);

/// A number, a material's name or a .csv. Throws InputError naming the flag.
RefractiveIndex parse_index(const std::string& flag, const std::string& text);

/// The crystal with a sphere diameter of its own, since that can be a range. Throws InputError naming the flag.
CrystalOptics parse_crystal(const CrystalFlags& flags, double sphere_diameter_nm);
std::vector<double> parse_diameters_nm(const CrystalFlags& flags);
PlaneFamily parse_planes(const CrystalFlags& flags);

/// The vacuum wavelengths of --wavelength-nm: 1 to 100,000 nm, and where one of the indices varies those that dispersion formulas
/// serve, index_from_nm to index_to_nm.
std::vector<double> parse_wavelengths_nm(const std::string& text, const RefractiveIndex& n_sphere,
                                         const RefractiveIndex& n_medium);

/// The one value of a flag that takes no range.
double single_value(const std::string& flag, const std::string& text, double low, double high);

}  // namespace opal
