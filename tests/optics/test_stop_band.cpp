// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "reference_table.h"
#include "renderer/optics/reflectance.h"

namespace opal {
namespace {

/// Columns of mpb_fcc_L_gap.csv (photonic band solver MPB 1.11.1, touching spheres, gap at L).
enum Column { n_sphere, n_medium, omega_low, omega_high, relative_gap, red_edge, blue_edge, middle };

CrystalOptics crystal_of(const std::vector<double>& row, IndexMean mean) {
    CrystalOptics crystal;
    crystal.sphere_diameter_nm = 250.0;
    crystal.n_sphere = row[n_sphere];
    crystal.n_medium = row[n_medium];
    crystal.index_mean = mean;
    return crystal;
}

double centre_deviation(const std::vector<double>& row, IndexMean mean) {
    const CrystalOptics crystal = crystal_of(row, mean);
    return bragg_wavelength_outside_nm(crystal, PlaneFamily{}, 0.0) / crystal.sphere_diameter_nm / row[middle] - 1.0;
}

bool in_air(const std::vector<double>& row) {
    return row[n_medium] < 1.3;
}

TEST(StopBand, CentreAgreesWithTheBandSolver) {
    const auto rows = read_reference_table("mpb_fcc_L_gap.csv");
    ASSERT_EQ(rows.size(), 11u);
    for (const auto& row : rows)
        EXPECT_LE(std::abs(centre_deviation(row, IndexMean::linear)), in_air(row) ? 0.006 : 0.001)
            << row[n_sphere] << " in " << row[n_medium];
}

TEST(StopBand, WidthAgreesWithTheBandSolver) {
    for (const auto& row : read_reference_table("mpb_fcc_L_gap.csv")) {
        const CrystalOptics crystal = crystal_of(row, IndexMean::linear);
        const double width = relative_band_width(crystal, PlaneFamily{}, 500.0, 1.0);
        EXPECT_LE(std::abs(width / row[relative_gap] - 1.0), in_air(row) ? 0.04 : 0.02)
            << row[n_sphere] << " in " << row[n_medium];
    }
}

/// Of the means on offer the linear one lies nearest to the band solver wherever the two can be told apart by its resolution
/// (about 1e-5 of the wavelength, from its six printed digits and 32 points per cell).
TEST(StopBand, TheLinearIndexIsNearerThanMaxwellGarnett) {
    for (const auto& row : read_reference_table("mpb_fcc_L_gap.csv")) {
        const double linear = std::abs(centre_deviation(row, IndexMean::linear)),
                     maxwell_garnett = std::abs(centre_deviation(row, IndexMean::maxwell_garnett)),
                     permittivity = std::abs(centre_deviation(row, IndexMean::permittivity));
        EXPECT_LT(linear, maxwell_garnett + 1.0e-5) << row[n_sphere] << " in " << row[n_medium];
        EXPECT_LT(linear, permittivity + 1.0e-5) << row[n_sphere] << " in " << row[n_medium];
    }
}

/// The curve of a thick slab is 1 within the band and falls off at its edges: the band of the reflectance is that of the formula,
/// but for the index in the coupling, whose square is not quite the mean permittivity.
TEST(StopBand, ThickSlabsReflectWithinTheBand) {
    for (const auto& row : read_reference_table("mpb_fcc_L_gap.csv")) {
        ReflectanceSetup setup;
        setup.crystal = crystal_of(row, IndexMean::linear);
        setup.layers = 1.0e6;
        const double centre_nm = bragg_wavelength_outside_nm(setup.crystal, setup.planes, 0.0);
        const double n_eff = setup.crystal.effective_index(500.0);
        const double expected = relative_band_width(setup.crystal, setup.planes, 500.0, 1.0) *
                                setup.crystal.mean_permittivity(500.0) / (n_eff * n_eff);
        const double step_nm = 0.001 * expected * centre_nm;
        double width_nm = 0.0;
        for (int i = -1000; i <= 1000; ++i)
            if (reflectance_at(setup, centre_nm + i * step_nm, 1.0).s > 0.9999) width_nm += step_nm;
        EXPECT_NEAR(width_nm / centre_nm, expected, 0.004 * expected);
    }
}

}  // namespace
}  // namespace opal
