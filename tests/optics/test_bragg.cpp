// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "formats/image.h"
#include "formats/units.h"
#include "renderer/optics/bragg_chart.h"
#include "renderer/optics/reflectance.h"

namespace opal {
namespace {

TEST(Bragg, FollowsTheLawOfBraggAndSnell) {
    const CrystalOptics crystal;
    const double n_eff = fcc_filling * 1.45 + (1.0 - fcc_filling) * 1.333;
    for (double angle_deg = 0.0; angle_deg <= 60.0; angle_deg += 5.0) {
        const double sine = std::sin(units::rad_from_deg(angle_deg));
        // Distance of (111) planes of touching spheres: sqrt(2/3) d; of (220): d / 2.
        const double expected = 2.0 * std::sqrt(2.0 / 3.0) * 250.0 * std::sqrt(n_eff * n_eff - sine * sine);
        EXPECT_NEAR(bragg_wavelength_outside_nm(crystal, {1, 1, 1}, units::rad_from_deg(angle_deg)), expected, 1e-9);
        EXPECT_NEAR(bragg_wavelength_outside_nm(crystal, {2, 2, 0}, units::rad_from_deg(angle_deg)),
                    250.0 * std::sqrt(n_eff * n_eff - sine * sine), 1e-9);
    }
}

TEST(Bragg, SettlesWithIndicesThatVary) {
    CrystalOptics crystal;
    crystal.n_sphere = RefractiveIndex::of_material("silica");
    crystal.n_medium = RefractiveIndex::of_material("water");
    for (const double diameter_nm : {160.0, 250.0, 400.0}) {
        crystal.sphere_diameter_nm = diameter_nm;
        const double wavelength_nm = bragg_wavelength_outside_nm(crystal, {1, 1, 1}, 0.5);
        const double n_eff = crystal.effective_index(wavelength_nm);
        EXPECT_NEAR(wavelength_nm,
                    2.0 * std::sqrt(2.0 / 3.0) * diameter_nm * std::sqrt(n_eff * n_eff - std::pow(std::sin(0.5), 2)), 1e-6);
        EXPECT_GT(std::abs(n_eff - crystal.effective_index(sodium_d_nm)), 1e-5);
    }
}

/// The reflectance of a slab peaks where the law says, at every angle, within a hundredth of its band.
TEST(Bragg, SlabsPeakAtTheBraggWavelength) {
    ReflectanceSetup setup;
    setup.layers = 60.0;
    for (double angle_deg = 0.0; angle_deg <= 60.0; angle_deg += 10.0) {
        const double bragg_nm = bragg_wavelength_outside_nm(setup.crystal, setup.planes, units::rad_from_deg(angle_deg));
        const double sine = std::sin(units::rad_from_deg(angle_deg)) / setup.crystal.effective_index(bragg_nm);
        const double cosine = std::sqrt(1.0 - sine * sine);
        double first = 0.0, second = 0.0;
        const double peak = reflectance_at(setup, bragg_nm, cosine).s;
        for (double x = -0.02; x <= 0.02; x += 1e-5) {
            const bool high = reflectance_at(setup, bragg_nm * (1.0 + x), cosine).s > 0.9 * peak;
            if (high && first == 0.0) first = bragg_nm * (1.0 + x);
            if (high) second = bragg_nm * (1.0 + x);
        }
        EXPECT_NEAR(0.5 * (first + second), bragg_nm, 2e-4 * bragg_nm) << angle_deg;
    }
}

/// Measured films of silica spheres in air (Coatings 2020, 10, 781): 187, 232 and 280 nm peak at 432, 532 and 640 nm. They are a
/// twentieth redder than the law for solid spheres of silica in air, in the same proportion: the films hold more than that.
TEST(Bragg, MeasuredSilicaFilms) {
    CrystalOptics crystal;
    crystal.n_sphere = RefractiveIndex::of_material("silica");
    crystal.n_medium = RefractiveIndex::of_material("air");
    const double films[][2] = {{187.0, 432.0}, {232.0, 532.0}, {280.0, 640.0}};
    for (const auto& film : films) {
        crystal.sphere_diameter_nm = film[0];
        const double ratio = bragg_wavelength_outside_nm(crystal, {1, 1, 1}, 0.0) / film[1];
        EXPECT_NEAR(ratio, 0.95, 0.01) << film[0];
    }
}

TEST(Bragg, SpacedSpheresDiffractFurtherToTheRed) {
    CrystalOptics crystal;
    crystal.filling = fcc_filling / 8.0;
    EXPECT_NEAR(crystal.cell_edge_nm(), 2.0 * std::sqrt(2.0) * 250.0, 1e-9);
}

TEST(BraggChart, ColoursAndGrey) {
    const auto green = spectral_display_color(530.0), red = spectral_display_color(620.0), blue = spectral_display_color(460.0);
    EXPECT_EQ(green[1], 1.0f);
    EXPECT_EQ(red[0], 1.0f);
    EXPECT_EQ(blue[2], 1.0f);
    EXPECT_LT(red[2], 0.1f);
    EXPECT_LT(spectral_display_color(385.0)[2], 0.5f);

    const BraggChart chart{{}, {}, 150.0, 350.0, 0.0, 60.0, "title"};
    const Image image = draw_bragg_chart(chart);
    // Bottom left: 150 nm seen from straight above, 348 nm: nothing to see. Half way along the bottom, 250 nm: orange at 580 nm.
    const float* const corner = image.pixel(92, 535);
    EXPECT_EQ(corner[0], corner[1]);
    EXPECT_EQ(corner[1], corner[2]);
    const float* const orange = image.pixel(450, 538);
    EXPECT_GT(orange[0], 0.9f);
    EXPECT_GT(orange[1], 0.5f);
    EXPECT_LT(orange[2], 0.1f);
}

}  // namespace
}  // namespace opal
