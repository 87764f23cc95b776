// SPDX-License-Identifier: Apache-2.0
#include "renderer/optics/crystal_optics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "formats/error.h"
#include "formats/units.h"

namespace opal {
namespace {

double squared(double x) {
    return x * x;
}

}  // namespace

double CrystalOptics::cell_edge_nm() const {
    return sphere_diameter_nm * std::cbrt(2.0 * units::pi / (3.0 * filling));
}

double CrystalOptics::mean_permittivity(double wavelength_nm) const {
    return filling * squared(n_sphere.at(wavelength_nm)) + (1.0 - filling) * squared(n_medium.at(wavelength_nm));
}

double CrystalOptics::effective_index(double wavelength_nm) const {
    const double sphere = n_sphere.at(wavelength_nm), medium = n_medium.at(wavelength_nm);
    switch (index_mean) {
        case IndexMean::linear:
            return filling * sphere + (1.0 - filling) * medium;
        case IndexMean::maxwell_garnett: {
            const double polarizability = (squared(sphere) - squared(medium)) / (squared(sphere) + 2.0 * squared(medium));
            return medium * std::sqrt(1.0 + 3.0 * filling * polarizability / (1.0 - filling * polarizability));
        }
        case IndexMean::permittivity:
            break;
    }
    return std::sqrt(mean_permittivity(wavelength_nm));
}

double PlaneFamily::g_per_nm(const CrystalOptics& crystal) const {
    return std::sqrt(double(h) * h + double(k) * k + double(l) * l) / crystal.cell_edge_nm();
}

bool PlaneFamily::allowed() const {
    return (h != 0 || k != 0 || l != 0) && (h - k) % 2 == 0 && (k - l) % 2 == 0;
}

int PlaneFamily::order() const {
    const int divisor = std::gcd(std::gcd(std::abs(h), std::abs(k)), std::abs(l));
    return PlaneFamily{h / divisor, k / divisor, l / divisor}.allowed() ? divisor : divisor / 2;
}

double permittivity_coefficient(const CrystalOptics& crystal, const PlaneFamily& planes, double wavelength_nm) {
    const double x = units::pi * planes.g_per_nm(crystal) * crystal.sphere_diameter_nm;
    const double contrast = squared(crystal.n_sphere.at(wavelength_nm)) - squared(crystal.n_medium.at(wavelength_nm));
    return contrast * crystal.filling * 3.0 * (std::sin(x) - x * std::cos(x)) / (x * x * x);
}

double bragg_wavelength_outside_nm(const CrystalOptics& crystal, const PlaneFamily& planes, double angle_outside_rad) {
    const double g_per_nm = planes.g_per_nm(crystal);
    const auto wavelength_at = [&](double wavelength_nm) {
        const double index = crystal.effective_index(std::clamp(wavelength_nm, index_from_nm, index_to_nm));
        return 2.0 * std::sqrt(squared(index) - squared(std::sin(angle_outside_rad))) / g_per_nm;
    };
    // Converges by a factor of about (lambda / n) dn/dlambda, some hundredths, each time.
    constexpr int max_steps = 100;
    constexpr double settled_nm = 1.0e-9;
    double wavelength_nm = wavelength_at(sodium_d_nm);
    for (int step = 0; step < max_steps; ++step) {
        const double next_nm = wavelength_at(wavelength_nm);
        if (std::abs(next_nm - wavelength_nm) < settled_nm) return next_nm;
        wavelength_nm = next_nm;
    }
    throw InputError(
        fmt::format("({},{},{}) at {:.6g} deg: no Bragg wavelength near {:.1f} nm, where the refractive index varies too fast",
                    planes.h, planes.k, planes.l, units::deg_from_rad(angle_outside_rad), wavelength_nm));
}

double relative_band_width(const CrystalOptics& crystal, const PlaneFamily& planes, double wavelength_nm, double cosine) {
    return std::abs(permittivity_coefficient(crystal, planes, wavelength_nm)) /
           (crystal.mean_permittivity(wavelength_nm) * cosine * cosine);
}

}  // namespace opal
