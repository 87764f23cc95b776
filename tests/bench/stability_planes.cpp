// SPDX-License-Identifier: GPL-3.0-or-later
#include "stability_planes.h"

#include <fmt/format.h>

#include <algorithm>

#include "cell_samples.h"
#include "formats/units.h"
#include "renderer/core/two_beam.h"
#include "renderer/optics/reflectance.h"
#include "renderer/optics/two_beam_block.h"
#include "three_beam.h"

namespace opal {
namespace {

constexpr double grain_mm = 1.5, coherence_nm = 25000.0;
constexpr double first_nm = 360.0, last_nm = 830.0;

CrystalParameters crystal_of(double sphere_diameter_nm) {
    return {sphere_diameter_nm, 1.45, 1.333};
}

double contrast_of(const CrystalParameters& crystal) {
    return std::abs(crystal.n_sphere * crystal.n_sphere - crystal.n_medium * crystal.n_medium);
}

/// |G| of (111) times a whole number's root: sqrt(h^2 + k^2 + l^2) / a.
double g_per_nm(const CrystalParameters& crystal, double square) {
    return std::sqrt(square) / (std::sqrt(2.0) * crystal.sphere_diameter_nm);
}

/// Families that turn light along `direction` with odds above 1 over the grain, s polarization.
int strong_families(const CrystalParameters& crystal, const std::vector<PlanePair>& pairs, const openvdb::Vec3d& direction,
                    double wavelength_nm) {
    LaneOptics<1> optics{};
    optics.wavelength_nm[0] = float(wavelength_nm);
    optics.n_eff[0] = float(effective_index(crystal));
    optics.contrast[0] = float(contrast_of(crystal));
    int strong = 0;
    for (const PlanePair& pair : pairs) {
        const double cosine =
            std::abs(direction.dot(openvdb::Vec3d(double(pair.normal.x), double(pair.normal.y), double(pair.normal.z))));
        if (cosine < 1.0e-4) continue;
        float rate_per_mm[1][beam_block_size];
        reflection_rates(single_beam(float(cosine), pair.g_per_nm, pair.form, float(coherence_nm), false), optics, 3.0e30f,
                         rate_per_mm);
        strong += double(rate_per_mm[0][0]) * grain_mm > 1.0 ? 1 : 0;
    }
    return strong;
}

std::vector<PlanePair> families_of(const CrystalParameters& crystal) {
    std::vector<PlanePair> pairs(max_tested_pairs);
    pairs.resize(std::size_t(std::min(max_tested_pairs, reciprocal_pairs(crystal, first_nm, pairs.data(), max_tested_pairs))));
    return pairs;
}

ReflectanceSetup setup_of(ReflectanceModel model) {
    ReflectanceSetup setup;
    setup.model = model;
    setup.layers = coherence_nm * g_per_nm(crystal_of(250.0), 3.0);
    setup.blocks = grain_mm * units::nm_per_um * 1000.0 / coherence_nm;
    return setup;
}

}  // namespace

EwaldBand ewald_band(double tolerance, int wavelengths) {
    const CrystalParameters crystal = crystal_of(250.0);
    const double bragg_nm = 2.0 * effective_index(crystal) / g_per_nm(crystal, 3.0), eta = crystal.n_sphere / crystal.n_medium;
    EwaldBand band;
    // At normal incidence the miss is 2 |lambda / lambda_B - 1|.
    band.width_nm = tolerance * bragg_nm;
    const double reflectance = polarized_fresnel(1.0, eta).s;
    band.energy_nm = reflectance * band.width_nm;
    band.paths_per_turn = (last_nm - first_nm) / band.energy_nm;
    double found = 0.0;
    for (int n = 0; n < wavelengths; ++n) {
        // Even steps over twice the band, finer than a float's: the wavelength that the renderer holds is rounded.
        const double place = 2.0 * (n + 0.5) / wavelengths - 1.0;
        const float ratio = float(bragg_nm + band.width_nm * place) / float(bragg_nm);
        found += 2.0 * double(ewald_fresnel_reflectance(ratio - 1.0f, 1.0f, float(eta), float(tolerance)).s) / reflectance;
    }
    band.single_over_double = found / wavelengths;
    return band;
}

EwaldBand two_beam_band() {
    const ReflectanceSetup setup = setup_of(ReflectanceModel::two_beam);
    EwaldBand band;
    double highest = 0.0;
    std::vector<double> reflectances;
    const double bragg_nm = bragg_wavelength_outside_nm(setup.crystal, setup.planes, 0.0);
    constexpr double step_nm = 0.002;
    for (double wavelength_nm = 0.8 * bragg_nm; wavelength_nm < 1.2 * bragg_nm; wavelength_nm += step_nm) {
        reflectances.push_back(reflectance_at(setup, wavelength_nm, 1.0).s);
        band.energy_nm += reflectances.back() * step_nm;
        highest = std::max(highest, reflectances.back());
    }
    for (const double reflectance : reflectances) band.width_nm += reflectance > 0.5 * highest ? step_nm : 0.0;
    band.paths_per_turn = (last_nm - first_nm) / band.energy_nm;
    return band;
}

ZoneEdge zone_edge(double angle_rad, double block_um) {
    const CrystalParameters crystal = crystal_of(250.0);
    const double n = effective_index(crystal), g = g_per_nm(crystal, 3.0), block_nm = block_um * units::nm_per_um;
    // From [110] towards [001]: the cosines to (111) and (11-1).
    const double sum = std::sqrt(2.0) * std::cos(angle_rad), difference = std::sin(angle_rad);
    const double cosine[2] = {(sum + difference) / std::sqrt(3.0), (sum - difference) / std::sqrt(3.0)};
    const double edge_nm = 2.0 * n * std::sqrt(2.0 / 3.0) / g;
    const double form = std::abs(permittivity_coefficient(crystal, g)),
                 cross_form = std::abs(permittivity_coefficient(crystal, g_per_nm(crystal, 4.0)));
    ZoneEdge result;
    double added_nm = 0.0, exact_nm = 0.0;
    const double reach = 0.05 + 2.0 * std::abs(cosine[0] / cosine[1] - 1.0), step = 1.0e-4;
    for (double detuning = -reach; detuning < reach; detuning += step) {
        const double wavelength_nm = edge_nm * (1.0 + detuning);
        ThreeBeamSlab slab{};
        double odds = 0.0;
        for (std::size_t j = 0; j < 2; ++j) {
            slab.coupling[j] = units::pi * form * block_nm / (n * wavelength_nm * cosine[j]);
            slab.detuning[j] = units::pi * g * block_nm * (2.0 * n * cosine[j] / (g * wavelength_nm) - 1.0);
            const double alone = two_beam_reflectance(slab.coupling[j], slab.detuning[j]);
            odds += alone / std::max(1.0e-12, 1.0 - alone);
        }
        slab.cross = slab.coupling[0] * cross_form / form;
        const double added = odds / (1.0 + odds), exact = three_beam_reflectance(slab);
        added_nm += added * step;
        exact_nm += exact * step;
        result.largest_error = std::max(result.largest_error, std::abs(added - exact));
    }
    result.energy_error = added_nm / exact_nm - 1.0;
    const openvdb::Vec3d direction(std::cos(angle_rad) / std::sqrt(2.0), std::cos(angle_rad) / std::sqrt(2.0),
                                   std::sin(angle_rad));
    result.strong_families = strong_families(crystal, families_of(crystal), direction, 2.0 * n * cosine[0] / g);
    return result;
}

Estimate multi_beam_share(double sphere_diameter_nm, int draws) {
    const CrystalParameters crystal = crystal_of(sphere_diameter_nm);
    const std::vector<PlanePair> pairs = families_of(crystal);
    cell_samples::Draws random(8);
    std::uint64_t turned = 0, several = 0;
    for (int n = 0; n < draws; ++n) {
        const Vec3 v = random.direction();
        const int strong = strong_families(crystal, pairs, {double(v.x), double(v.y), double(v.z)},
                                           first_nm + (last_nm - first_nm) * random.next());
        turned += strong > 0 ? 1 : 0;
        several += strong > 1 ? 1 : 0;
    }
    return share_of(several, turned);
}

void add_ewald_rows(bool quick, StabilityRows& rows) {
    const EwaldBand reference = two_beam_band();
    const std::string outcome = "for comparison alone: noted at load that brightness follows the tolerance; refused above 0.5",
                      test = "Stability.EwaldEnergyFollowsTheTolerance";
    for (const double tolerance : {1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 1e-4, 1e-5, 1e-6}) {
        const EwaldBand band = ewald_band(tolerance, quick ? 20000 : 200000);
        const auto add = [&](const std::string& method, Estimate error, const std::string& unit) {
            rows.push_back({"Ewald tolerance", method, "opal.ewald_tolerance", tolerance, error, unit, outcome, test});
        };
        add("ewald-fresnel", {band.energy_nm / reference.energy_nm, 0.0}, "reflected energy over two-beam's");
        add("ewald-fresnel", {band.width_nm / reference.width_nm, 0.0}, "width of the band over two-beam's");
        add("ewald-fresnel in single precision", {std::abs(band.single_over_double - 1.0), 0.0},
            "error of the energy by rounding");
        add("ewald-fresnel", {band.paths_per_turn, 0.0}, "wavelengths drawn per reflected one");
    }
}

void add_zone_rows(bool quick, StabilityRows& rows) {
    const std::string outcome = "energy kept, split by rates; counted in --stats (multi_beam_stays)",
                      test = "Stability.FamiliesTogetherNearZoneEdges";
    for (const double angle_deg : {0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 2.0, 5.0})
        for (const double block_um : {10.0, 25.0}) {
            const ZoneEdge edge = zone_edge(units::rad_from_deg(angle_deg), block_um);
            const auto add = [&](Estimate error, const std::string& unit) {
                rows.push_back({"zone edges", fmt::format("two-beam, odds added, blocks of {} um", block_um),
                                "angle from the edge (deg)", angle_deg, error, unit, outcome, test});
            };
            add({std::abs(edge.energy_error), 0.0}, "error of the reflected energy against three-beam theory");
            add({edge.largest_error, 0.0}, "largest error of the reflectance");
            if (block_um == 25.0) add({double(edge.strong_families), 0.0}, "families that reflect more than half");
        }
    for (const double diameter_nm : {200.0, 250.0, 300.0, 350.0, 400.0})
        rows.push_back({"zone edges", "two-beam, random light", "sphere diameter (nm)", diameter_nm,
                        multi_beam_share(diameter_nm, quick ? 20000 : 400000),
                        "share of reflected light with two or more strong families", outcome, test});
}

}  // namespace opal
