// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "formats/refractive_index.h"

namespace opal {

enum class MaterialKind { diffuse, dielectric, conductor, plastic };

/// What fills a dielectric. With a density file the coefficients are per unit of density.
struct MediumDescription {
    std::string absorber = "neutral";  ///< built-in spectrum, or a .csv's path
    double sigma_a_per_mm = 0.0;       ///< at sigma_a_reference_nm
    double sigma_a_reference_nm = 550.0;
    double sigma_s_per_mm = 0.0;
    double asymmetry = 0.0;              ///< mean cosine of scattering, Henyey-Greenstein
    std::filesystem::path density_file;  ///< .vdb with a fog grid in the object's own mm; empty: the same everywhere
    std::string density_grid;            ///< its name; empty: the first grid of floats
    double density_scale = 1.0;          ///< factor on the density
};

/// One [[material]]; each kind uses its own keys.
struct MaterialDescription {
    std::string name;
    MaterialKind kind = MaterialKind::diffuse;
    std::array<double, 3> albedo = {0.5, 0.5, 0.5};  ///< diffuse, plastic: linear sRGB reflectance (plastic: of the base)
    RefractiveIndex n = 1.5;                         ///< dielectric; plastic: of the coat
    double roughness = 0.0;                          ///< dielectric, conductor, plastic: GGX alpha; 0: smooth
    std::string metal = "gold";                      ///< conductor: built-in metal, or a .csv's path
    MediumDescription medium;                        ///< dielectric
};

}  // namespace opal
