// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace opal {

/// Complex refractive index n + i k of an absorber.
struct ComplexIndex {
    double n = 1.0;
    double k = 0.0;
};

/// Optical constants of a metal over the vacuum wavelength: a built-in metal or a table. The built-in ones are fits (see
/// fit_metals.py) to measurements as refractiveindex.info lists them:
///  - "gold", "silver", "copper": Johnson & Christy, "Optical constants of the noble metals", Phys. Rev. B 6, 1972
///  - "platinum": Tselin et al. 2024
///  - "rhodium": Weaver, Olson & Lynch, "Optical investigation of the electronic structure of bulk Rh and Ir", Phys. Rev. B 15,
///    1977; what white gold is plated with
///  - "gold-silver": an alloy of equal parts, Rioux et al., "An analytic model for the dielectric function of Au, Ag, and their
///    alloys", Adv. Opt. Mater. 2, 2014
class MetalIndex {
  public:
    /// Throws InputError for other names, naming those there are.
    static MetalIndex of_metal(const std::string& name);
    /// Columns wavelength_nm, n, k; '#' starts a comment, one header line is allowed; linear between the samples, constant beyond
    /// them. Throws InputError with file:line.
    static MetalIndex from_csv(const std::filesystem::path& path);
    /// A path where the text ends in .csv, else a name.
    static MetalIndex from_name(const std::string& name_or_path);

    ComplexIndex at(double wavelength_nm) const;

  private:
    const struct MetalFit* fit_ = nullptr;
    std::vector<double> wavelength_nm_;
    std::vector<ComplexIndex> index_;
};

const std::vector<std::string>& metal_names();

/// Reflectance at normal incidence from a dielectric of index `n_before`.
double normal_reflectance(ComplexIndex index, double n_before = 1.0);

}  // namespace opal
