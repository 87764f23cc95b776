// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "formats/spectrum.h"

namespace opal {

/// Wavelength at which a single number stands for an index that varies: the sodium D line.
inline constexpr double sodium_d_nm = 589.3;

/// Refractive index over the vacuum wavelength: a constant, a named material, or a table.
///  - "silica": fused silica, Sellmeier terms of Malitson, "Interspecimen comparison of the refractive index of fused silica",
///    J. Opt. Soc. Am. 55, 1965 (20 C, 0.21 to 3.71 um).
///  - "water": Daimon & Masumura, "Measurement of the refractive index of distilled water from the near-infrared region to the
///    ultraviolet region", Appl. Opt. 46, 2007 (20.0 C, 0.182 to 1.129 um).
///  - "air": Ciddor, "Refractive index of air: new equations for the visible and near infrared", Appl. Opt. 35, 1996 (15 C,
///    101325 Pa, dry, 450 ppm CO2).
///  - "resin": acrylic glass (PMMA), Sultanova, Kasarova & Nikolov, "Dispersion properties of optical polymers", Acta Phys. Pol.
///  A
///    116, 2009 (measured from 437 nm; the one-term Sellmeier form is carried on to 360 nm).
class RefractiveIndex {
  public:
    RefractiveIndex(double constant) : constant_(constant) {}
    /// A built-in material. Throws InputError for other names, naming those there are.
    static RefractiveIndex of_material(const std::string& name);
    /// Columns wavelength_nm and n. Throws InputError for what read_spectrum_csv refuses and for values outside [1, 4].
    static RefractiveIndex from_csv(const std::filesystem::path& path);
    /// What `to_text` wrote. Throws InputError.
    static RefractiveIndex from_text(const std::string& text);

    /// Index at a vacuum wavelength.
    double at(double wavelength_nm) const;
    bool varies() const { return !name_.empty(); }
    /// A material's name, a table's file, or empty for a constant.
    const std::string& name() const { return name_; }
    /// A number, a material's name or a table "360:1.47 365:1.469 ...": the form in which it travels in .vdb metadata.
    std::string to_text() const;

    bool operator==(const RefractiveIndex& other) const { return to_text() == other.to_text(); }

  private:
    double constant_;
    std::string name_;
    SampledSpectrum table_;
};

const std::vector<std::string>& refractive_materials();

}  // namespace opal
