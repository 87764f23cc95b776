// SPDX-License-Identifier: Apache-2.0
#include "renderer/optics/reflectance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "formats/units.h"
#include "renderer/optics/plane_profile.h"
#include "renderer/optics/transfer_matrix.h"
#include "renderer/optics/two_beam_block.h"

namespace opal {
namespace {

/// Coupling and detuning per distance of two planes, 1 / |G|.
struct PlaneCoupling {
    double kappa_d_s, kappa_d_p;
    double delta_d;
};

PlaneCoupling plane_coupling(const ReflectanceSetup& setup, double wavelength_nm, double cosine) {
    const double n_eff = setup.crystal.effective_index(wavelength_nm), g_per_nm = setup.planes.g_per_nm(setup.crystal);
    const double epsilon = std::abs(permittivity_coefficient(setup.crystal, setup.planes, wavelength_nm));
    const double bragg_nm = 2.0 * n_eff * cosine / g_per_nm;
    const double kappa_d = units::pi * epsilon / (n_eff * wavelength_nm * cosine * g_per_nm);
    return {kappa_d, kappa_d * std::abs(1.0 - 2.0 * cosine * cosine), units::pi * (bragg_nm / wavelength_nm - 1.0)};
}

PolarizedReflectance<double> two_beam(const ReflectanceSetup& setup, double wavelength_nm, double cosine) {
    const PlaneCoupling plane = plane_coupling(setup, wavelength_nm, cosine);
    if (plane.delta_d < -0.5 * units::pi || plane.delta_d > units::pi) return {0.0, 0.0};
    const double delta_t = setup.layers * plane.delta_d;
    return {two_beam_reflectance(setup.layers * plane.kappa_d_s, delta_t),
            two_beam_reflectance(setup.layers * plane.kappa_d_p, delta_t)};
}

PolarizedReflectance<double> laue(const ReflectanceSetup& setup, double wavelength_nm, double cosine) {
    const PlaneCoupling plane = plane_coupling(setup, wavelength_nm, cosine);
    return {laue_reflectance(plane.kappa_d_s, plane.delta_d, setup.layers),
            laue_reflectance(plane.kappa_d_p, plane.delta_d, setup.layers)};
}

PolarizedReflectance<double> ewald_fresnel(const ReflectanceSetup& setup, double wavelength_nm, double cosine) {
    const CrystalOptics& crystal = setup.crystal;
    const double bragg_nm = 2.0 * crystal.effective_index(wavelength_nm) * cosine / setup.planes.g_per_nm(crystal);
    return ewald_fresnel_reflectance(wavelength_nm / bragg_nm - 1.0, cosine,
                                     crystal.n_sphere.at(wavelength_nm) / crystal.n_medium.at(wavelength_nm),
                                     setup.ewald_tolerance);
}

CharacteristicMatrix matrix_of(const std::vector<Film>& films, Polarization polarization, double wavelength_nm,
                               double tangential) {
    CharacteristicMatrix product;
    for (const Film& film : films) product = product * characteristic_matrix(film, polarization, wavelength_nm, tangential);
    return product;
}

/// The first `part` of a period, in [0, 1).
std::vector<Film> front_of(const std::vector<Film>& period, double part) {
    const double films = part * double(period.size());
    std::vector<Film> front(period.begin(), period.begin() + std::ptrdiff_t(films));
    front.push_back(period[front.size()]);
    front.back().thickness_nm *= films - std::floor(films);
    return front;
}

PolarizedReflectance<double> transfer_matrix(const ReflectanceSetup& setup, double wavelength_nm, double cosine) {
    const double ambient = direction_index(setup, wavelength_nm);
    const double tangential = ambient * std::sqrt(1.0 - cosine * cosine);
    const double periods = setup.layers / setup.planes.order();
    // A whole number of periods stays one in spite of rounding.
    const long whole = std::lround(std::floor(periods * (1.0 + 1.0e-12)));
    std::vector<Film> repeated, rest;
    if (setup.ambient == Ambient::medium) {
        rest = plane_averaged_slab(setup.crystal, setup.planes, wavelength_nm, whole, setup.slices_per_period);
    } else {
        repeated = plane_averaged_period(setup.crystal, setup.planes, wavelength_nm, setup.slices_per_period);
        rest = front_of(repeated, std::max(0.0, periods - double(whole)));
    }
    const auto response = [&](Polarization polarization) {
        const CharacteristicMatrix stack = power(matrix_of(repeated, polarization, wavelength_nm, tangential), whole) *
                                           matrix_of(rest, polarization, wavelength_nm, tangential);
        return stack_response(stack, polarization, ambient, ambient, cosine).reflectance;
    };
    return {response(Polarization::s), response(Polarization::p)};
}

PolarizedReflectance<double> slab_reflectance(const ReflectanceSetup& setup, double wavelength_nm, double cosine) {
    switch (setup.model) {
        case ReflectanceModel::ewald_fresnel:
            return ewald_fresnel(setup, wavelength_nm, cosine);
        case ReflectanceModel::laue:
            return laue(setup, wavelength_nm, cosine);
        case ReflectanceModel::transfer_matrix:
            return transfer_matrix(setup, wavelength_nm, cosine);
        case ReflectanceModel::two_beam:
            break;
    }
    return two_beam(setup, wavelength_nm, cosine);
}

}  // namespace

double direction_index(const ReflectanceSetup& setup, double wavelength_nm) {
    if (setup.model != ReflectanceModel::transfer_matrix) return setup.crystal.effective_index(wavelength_nm);
    if (setup.ambient == Ambient::medium) return setup.crystal.n_medium.at(wavelength_nm);
    return std::sqrt(setup.crystal.mean_permittivity(wavelength_nm));
}

PolarizedReflectance<double> reflectance_at(const ReflectanceSetup& setup, double wavelength_nm, double cosine) {
    const PolarizedReflectance<double> slab = slab_reflectance(setup, wavelength_nm, cosine);
    return {pile_reflectance(slab.s, setup.blocks), pile_reflectance(slab.p, setup.blocks)};
}

}  // namespace opal
