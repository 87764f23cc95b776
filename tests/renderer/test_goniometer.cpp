// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "formats/units.h"
#include "goniometer.h"
#include "on_backends.h"
#include "small_opal.h"

namespace opal {
namespace {

class Goniometry : public OnBackends {};
class GoniometryLoop : public OnBackends {};
class Reciprocity : public OnBackends {};

/// Quaternion that turns the lattice's [111] onto +Z.
openvdb::math::Quat<float> stacking_axis_up() {
    const openvdb::Vec3f axis = openvdb::Vec3f(1.0f, -1.0f, 0.0f).unit();
    return {axis, float(std::acos(std::sqrt(1.0 / 3.0)))};
}

/// A plate of one grain, its (111) planes along its faces.
OpalAsset oriented_plate(const OpalConstants& constants) {
    SmallOpal small;
    small.radius_mm = 4.0;
    small.half_thickness_mm = 0.5;
    small.grains = 1;
    small.constants = constants;
    OpalAsset asset = small.make();
    asset.grain_orientations = {stacking_axis_up()};
    return asset;
}

/// Wavelength in the middle of the band in which a plate sends more than half of the light back to the side it came from. The
/// band has to lie inside the window of 2 % to either side, or there is no answer (0).
double measured_peak_nm(const Goniometer& goniometer, double angle_rad, double window_centre_nm) {
    const Vec3 direction{float(std::sin(angle_rad)), 0.0f, float(-std::cos(angle_rad))};
    constexpr int reach = 80;
    int first = reach + 1, last = -reach - 1;
    for (int step = -reach; step <= reach; ++step) {
        const auto reading = goniometer.radiance(direction, 0.05, window_centre_nm * (1.0 + 2.5e-4 * step), 400, 1);
        if (reading.mean < 0.5) continue;
        first = std::min(first, step);
        last = std::max(last, step);
    }
    if (first <= -reach || last >= reach || first > last) return 0.0;
    return window_centre_nm * (1.0 + 2.5e-4 * 0.5 * (first + last));
}

/// lambda = 2 D sqrt(n^2 - sin^2 theta), D the distance of the planes, theta the angle in air, n at that very wavelength.
double bragg_snell_nm(const OpalConstants& constants, double angle_rad) {
    double wavelength_nm = 550.0;
    for (int i = 0; i < 50; ++i) {
        const double n =
            fcc_filling * constants.n_sphere.at(wavelength_nm) + (1.0 - fcc_filling) * constants.n_medium.at(wavelength_nm);
        wavelength_nm =
            2.0 * std::sqrt(2.0 / 3.0) * constants.sphere_diameter_nm * std::sqrt(n * n - std::pow(std::sin(angle_rad), 2));
    }
    return wavelength_nm;
}

/// Blocks as thick as the plate: where more of them pile up, the tails of the band alone turn half of the light back.
void expect_bragg_snell(OpalConstants constants, const std::string& backend) {
    constants.coherence_length_um = 1000.0;
    const ScratchFolder folder;
    write_opal_asset(oriented_plate(constants), folder / "plate.vdb");
    write_cap(folder / "above.exr", {0.0f, 0.0f, 1.0f}, 90.0);
    const Goniometer goniometer("[environment]\nfile = '" + (folder / "above.exr").string() +
                                    "'\n[[object]]\nkind = \"opal\"\nfile = '" + (folder / "plate.vdb").string() + "'\n",
                                2.0, backend);
    for (double angle_deg = 0.0; angle_deg <= 60.0; angle_deg += 10.0) {
        const double angle_rad = units::rad_from_deg(angle_deg);
        const double expected_nm = bragg_snell_nm(constants, angle_rad);
        const double measured_nm = measured_peak_nm(goniometer, angle_rad, 1.005 * expected_nm);
        ::testing::Test::RecordProperty("at_" + std::to_string(int(angle_deg)) + "_deg",
                                        std::to_string(measured_nm) + " " + std::to_string(expected_nm));
        EXPECT_NEAR(measured_nm, expected_nm, 0.003 * expected_nm) << angle_deg << " deg";
    }
}

TEST_P(Goniometry, PlatesPeakWhereBraggAndSnellSay) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 250.0;
    expect_bragg_snell(small.constants, GetParam());
}

TEST_P(Goniometry, PlatesThatDisperseDoSoToo) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 230.0;
    small.constants.n_sphere = RefractiveIndex::of_material("silica");
    small.constants.n_medium = RefractiveIndex::of_material("water");
    expect_bragg_snell(small.constants, GetParam());
}

/// Reflectance of a pile of blocks, M r / (1 + (M - 1) r), averaged over the blocks' triangular spread of thickness: normal
/// incidence, planes along the faces, `detuning` = lambda / lambda_B - 1.
double pile_reflectance(const CrystalParameters& crystal, double coherence_nm, double thickness_nm, double wavelength_nm) {
    const double g_per_nm = std::sqrt(1.5) / crystal.sphere_diameter_nm, n = effective_index(crystal);
    const double kappa_per_nm = units::pi * std::abs(permittivity_coefficient(crystal, g_per_nm)) / (n * wavelength_nm);
    const double delta_per_nm = 2.0 * units::pi * (n / wavelength_nm - 0.5 * g_per_nm);
    const std::complex<double> gamma = std::sqrt(std::complex<double>(kappa_per_nm * kappa_per_nm - delta_per_nm * delta_per_nm));
    double mean = 0.0;
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i) {
        const double x = (i + 0.5) / steps;
        const double t_nm = coherence_nm * (0.5 + x);
        const double odds =
            kappa_per_nm * kappa_per_nm * (std::sinh(gamma * t_nm) * std::sinh(gamma * t_nm) / (gamma * gamma)).real();
        const double blocks = thickness_nm / t_nm;
        mean += (x < 0.5 ? 4.0 * x : 4.0 - 4.0 * x) / steps * (blocks * odds / (1.0 + blocks * odds));
    }
    return mean;
}

/// The whole walk through a plate of one grain, against the pile's formula between the plate's faces (intensities added):
/// reflected by a face F, by the pile R, by the far face.
TEST_P(GoniometryLoop, PlatesReflectAsPilesOfBlocksDo) {
    for (const double blocks : {1.0, 12.0, 200.0}) {
        SmallOpal small;
        small.constants.n_medium = 1.42;
        small.constants.coherence_length_um = 1000.0 / blocks;
        const ScratchFolder folder;
        write_opal_asset(oriented_plate(small.constants), folder / "plate.vdb");
        write_cap(folder / "above.exr", {0.0f, 0.0f, 1.0f}, 90.0);
        const Goniometer goniometer("[environment]\nfile = '" + (folder / "above.exr").string() +
                                        "'\n[opal]\nmax_odds = 1e6\n[[object]]\nkind = \"opal\"\nfile = '" +
                                        (folder / "plate.vdb").string() + "'\n",
                                    2.0, GetParam());
        const CrystalParameters crystal{250.0, 1.45, 1.42};
        const double n = effective_index(crystal), face = std::pow((n - 1.0) / (n + 1.0), 2);
        const double bragg_nm = 2.0 * n * std::sqrt(2.0 / 3.0) * 250.0;
        for (const double detuning : {-0.004, -0.0015, 0.0, 0.001, 0.0025}) {
            // One block as thick as the plate reflects everything inside the band: no walk there to test.
            if (blocks == 1.0 && std::abs(detuning) < 0.0022) continue;
            const double wavelength_nm = bragg_nm * (1.0 + detuning);
            const double pile = pile_reflectance(crystal, 1.0e6 / blocks, 1.0e6, wavelength_nm), passed = 1.0 - pile;
            const double below = pile + passed * passed * face / (1.0 - pile * face);
            const double expected = face + (1.0 - face) * (1.0 - face) * below / (1.0 - face * below);
            const auto reading = goniometer.radiance({0.0f, 0.0f, -1.0f}, 0.05, wavelength_nm, 8000, 1);
            EXPECT_NEAR(reading.mean, expected, 4.0 * reading.standard_error) << blocks << " blocks, detuned by " << detuning;
            EXPECT_LT(reading.standard_error, 0.006);
        }
    }
}

/// Emitter and detector change places: the flux must not. The sample is a ball of grains in random orientations; directions 90
/// degrees apart, so that what arrives was turned by planes, by scattering or by the surface more than once.
void expect_reciprocal(const SmallOpal& small, const std::string& backend, double wavelength_nm, int paths) {
    const ScratchFolder folder;
    write_opal_asset(small.make(), folder / "ball.vdb");
    write_cap(folder / "a.exr", normalize({0.2f, -0.3f, 1.0f}), 40.0);
    write_cap(folder / "b.exr", normalize({1.0f, 0.3f, -0.1f}), 40.0);
    const auto flux = [&](const char* emitter, const char* detector, std::uint64_t seed) {
        const Goniometer goniometer("[environment]\nfile = '" + (folder / emitter).string() +
                                        "'\n[[object]]\nkind = \"opal\"\nfile = '" + (folder / "ball.vdb").string() + "'\n",
                                    1.05 * small.radius_mm, backend);
        return goniometer.exchange(read_environment(folder / detector), wavelength_nm, paths, seed);
    };
    const auto forth = flux("a.exr", "b.exr", 1), back = flux("b.exr", "a.exr", 2);
    const double error = std::hypot(forth.standard_error, back.standard_error);
    const std::string at = "at_" + std::to_string(int(wavelength_nm)) + "_nm_";
    ::testing::Test::RecordProperty(at + "forth_back_error",
                                    std::to_string(forth.mean) + " " + std::to_string(back.mean) + " " + std::to_string(error));
    EXPECT_NEAR(forth.mean, back.mean, 3.0 * error) << wavelength_nm << " nm";
    EXPECT_LT(error, 0.015 * forth.mean) << "too noisy to say anything";
}

TEST_P(Reciprocity, OfManyGrains) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 300.0;
    small.constants.sigma_a_per_mm = absorber_spectrum("carbon", 0.05);
    for (const double wavelength_nm : {460.0, 600.0}) expect_reciprocal(small, GetParam(), wavelength_nm, 200000);
}

TEST_P(Reciprocity, OfManyGrainsInAirWithScatteringAndDisorder) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 300.0;
    small.constants.n_medium = 1.0;
    small.constants.sigma_s_rayleigh_400nm_per_mm = 0.05;
    small.constants.sigma_s_mie_per_mm = 0.05;
    small.constants.mosaic_spread_deg = 2.0;
    small.constants.stacking_fault_probability = 0.1;
    small.constants.sigma_a_per_mm = absorber_spectrum("carbon", 0.05);
    expect_reciprocal(small, GetParam(), 520.0, 200000);
}

INSTANTIATE_TEST_SUITE_P(, Goniometry, cpu_and_cuda(), backend_name);
INSTANTIATE_TEST_SUITE_P(, GoniometryLoop, cpu_loop_and_cuda(), backend_name);
INSTANTIATE_TEST_SUITE_P(, Reciprocity, cpu_and_cuda(), backend_name);

}  // namespace
}  // namespace opal
