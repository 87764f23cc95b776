// SPDX-License-Identifier: Apache-2.0
#include "formats/refractive_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/error.h"
#include "formats/text.h"

namespace opal {
namespace {

struct SellmeierTerm {
    double strength;
    double resonance_um2;
};

/// n^2 = 1 + sum of strength L^2 / (L^2 - resonance), L the wavelength in micrometres.
double sellmeier(std::initializer_list<SellmeierTerm> terms, double wavelength_nm) {
    const double square_um2 = wavelength_nm * wavelength_nm * 1.0e-6;
    double sum = 1.0;
    for (const SellmeierTerm& term : terms) sum += term.strength * square_um2 / (square_um2 - term.resonance_um2);
    return std::sqrt(sum);
}

double silica(double wavelength_nm) {
    return sellmeier({{0.6961663, 0.0684043 * 0.0684043}, {0.4079426, 0.1162414 * 0.1162414}, {0.8974794, 9.896161 * 9.896161}},
                     wavelength_nm);
}

double water(double wavelength_nm) {
    return sellmeier({{5.684027565e-1, 5.101829712e-3},
                      {1.726177391e-1, 1.821153936e-2},
                      {2.086189578e-2, 2.620722293e-2},
                      {1.130748688e-1, 1.069792721e1}},
                     wavelength_nm);
}

double air(double wavelength_nm) {
    const double wavenumber2_per_um2 = 1.0e6 / (wavelength_nm * wavelength_nm);
    return 1.0 + 0.05792105 / (238.0185 - wavenumber2_per_um2) + 0.00167917 / (57.362 - wavenumber2_per_um2);
}

double resin(double wavelength_nm) {
    return sellmeier({{1.1819, 0.011313}}, wavelength_nm);
}

void require_allowed(const SampledSpectrum& table, const std::string& whose) {
    for (std::size_t i = 0; i < table.value.size(); ++i)
        if (!(table.value[i] >= 1.0 && table.value[i] <= 4.0))
            throw InputError(fmt::format("{}: index {} at {} nm is out of range; allowed: 1 to 4", whose, table.value[i],
                                         table.wavelength_nm[i]));
}

}  // namespace

const std::vector<std::string>& refractive_materials() {
    static const std::vector<std::string> names = {"silica", "water", "air", "resin"};
    return names;
}

RefractiveIndex RefractiveIndex::of_material(const std::string& name) {
    const std::vector<std::string>& names = refractive_materials();
    if (std::find(names.begin(), names.end(), name) == names.end())
        throw InputError(fmt::format("'{}' is not a known material; allowed: a number from 1 to 4, {} or a .csv's path{}", name,
                                     join(names), did_you_mean(name, names)));
    RefractiveIndex index(0.0);
    index.name_ = name;
    index.constant_ = index.at(sodium_d_nm);
    return index;
}

RefractiveIndex RefractiveIndex::from_csv(const std::filesystem::path& path) {
    RefractiveIndex index(0.0);
    index.name_ = path.string();
    index.table_ = read_spectrum_csv(path);
    require_allowed(index.table_, path.string());
    index.constant_ = index.at(sodium_d_nm);
    return index;
}

RefractiveIndex RefractiveIndex::from_text(const std::string& text) {
    if (text.find(':') != std::string::npos) {
        RefractiveIndex index(0.0);
        index.name_ = "table";
        index.table_ = spectrum_from_text(text);
        require_allowed(index.table_, "table");
        index.constant_ = index.at(sodium_d_nm);
        return index;
    }
    const std::vector<std::string>& names = refractive_materials();
    if (std::find(names.begin(), names.end(), text) != names.end()) return of_material(text);
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !(value >= 1.0 && value <= 4.0))
        throw InputError(fmt::format("'{}' is neither an index from 1 to 4 nor one of {}", text, join(names)));
    return RefractiveIndex(value);
}

double RefractiveIndex::at(double wavelength_nm) const {
    if (name_.empty()) return constant_;
    if (!table_.value.empty()) return table_.at(wavelength_nm);
    if (name_ == "silica") return silica(wavelength_nm);
    if (name_ == "water") return water(wavelength_nm);
    return name_ == "air" ? air(wavelength_nm) : resin(wavelength_nm);
}

std::string RefractiveIndex::to_text() const {
    if (name_.empty()) return fmt::format("{}", constant_);
    return table_.value.empty() ? name_ : spectrum_to_text(table_);
}

}  // namespace opal
