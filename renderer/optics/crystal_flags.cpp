// SPDX-License-Identifier: Apache-2.0
#include "renderer/optics/crystal_flags.h"

#include <fmt/format.h>

#include <cmath>

#include "formats/error.h"
#include "renderer/optics/value_list.h"

namespace opal {
namespace {

constexpr double diameter_min_nm = 10.0, diameter_max_nm = 1.0e4;
/// Largest filling as people round it; the lattice is that of touching spheres then.
constexpr double rounded_fcc_filling = 0.7405;
constexpr int largest_miller_index = 100;

}  // namespace

void add_sphere_flags(CLI::App& command, CrystalFlags& flags) {
    command.add_option("--sphere-diameter-nm", flags.sphere_diameter_nm, "diameter of the spheres, nm")
        ->capture_default_str()
        ->type_name("NM");
    command.add_option("--n-sphere", flags.n_sphere, "index of the spheres: a number, silica, water, air, resin or a .csv")
        ->capture_default_str()
        ->type_name("INDEX");
    command.add_option("--n-medium", flags.n_medium, "index of what is between them, likewise")
        ->capture_default_str()
        ->type_name("INDEX");
}

void add_crystal_flags(CLI::App& command, CrystalFlags& flags) {
    add_sphere_flags(command, flags);
    command.add_option("--hkl", flags.hkl, "lattice planes parallel to the surface, fcc cubic axes: all even or all odd")
        ->capture_default_str()
        ->type_name("H,K,L");
    command
        .add_option("--filling", flags.filling,
                    "part of the volume inside spheres (default: touching, 0.74048); less sets the spheres apart")
        ->type_name("F");
    command.add_option("--index-mean", flags.index_mean, "how the effective index is taken")
        ->check(CLI::IsMember({"linear", "maxwell-garnett", "permittivity"}))
        ->capture_default_str();
}

RefractiveIndex parse_index(const std::string& flag, const std::string& text) {
    try {
        if (text.ends_with(".csv")) return RefractiveIndex::from_csv(text);
        const bool is_number = !text.empty() && text.find_first_not_of("0123456789.eE+-") == std::string::npos;
        return is_number ? RefractiveIndex::from_text(text) : RefractiveIndex::of_material(text);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", flag, error.what()));
    }
}

double single_value(const std::string& flag, const std::string& text, double low, double high) {
    const std::vector<double> values = parse_values(flag, text, low, high);
    if (values.size() != 1) throw InputError(fmt::format("{} {}: expected one number", flag, text));
    return values.front();
}

CrystalOptics parse_crystal(const CrystalFlags& flags, double sphere_diameter_nm) {
    CrystalOptics crystal;
    crystal.sphere_diameter_nm = sphere_diameter_nm;
    crystal.n_sphere = parse_index("--n-sphere", flags.n_sphere);
    crystal.n_medium = parse_index("--n-medium", flags.n_medium);
    if (!flags.filling.empty())
        crystal.filling = std::min(fcc_filling, single_value("--filling", flags.filling, 1.0e-3, rounded_fcc_filling));
    if (flags.index_mean == "maxwell-garnett") crystal.index_mean = IndexMean::maxwell_garnett;
    if (flags.index_mean == "permittivity") crystal.index_mean = IndexMean::permittivity;
    return crystal;
}

std::vector<double> parse_wavelengths_nm(const std::string& text, const RefractiveIndex& n_sphere,
                                         const RefractiveIndex& n_medium) {
    const bool varies = n_sphere.varies() || n_medium.varies();
    return parse_values("--wavelength-nm", text, varies ? index_from_nm : 1.0, varies ? index_to_nm : 1.0e5);
}

std::vector<double> parse_diameters_nm(const CrystalFlags& flags) {
    return parse_values("--sphere-diameter-nm", flags.sphere_diameter_nm, diameter_min_nm, diameter_max_nm);
}

PlaneFamily parse_planes(const CrystalFlags& flags) {
    const std::vector<double> indices =
        parse_values("--hkl", flags.hkl, -double(largest_miller_index), double(largest_miller_index));
    bool whole = indices.size() == 3 && flags.hkl.find(':') == std::string::npos;
    for (const double index : indices) whole = whole && index == std::floor(index);
    if (!whole) throw InputError(fmt::format("--hkl {}: expected three whole numbers h,k,l", flags.hkl));
    const PlaneFamily planes{int(indices[0]), int(indices[1]), int(indices[2])};
    if (!planes.allowed())
        throw InputError(fmt::format("--hkl {}: fcc has no such reflection; allowed: all even or all odd, not 0,0,0", flags.hkl));
    return planes;
}

}  // namespace opal
