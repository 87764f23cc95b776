// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <vector>

#include "renderer/core/crystal.h"

namespace opal {
namespace {

/// The published counts with the origin (source method's Table 6.1; silica in water): 15, 15, 27, 27, 59.
TEST(Crystal, ReciprocalPointsInTheLimitingSphere) {
    const struct {
        double diameter_nm;
        int points;
    } rows[] = {{210.0, 15}, {250.0, 15}, {260.0, 27}, {280.0, 27}, {350.0, 59}};
    for (const auto& row : rows) {
        const CrystalParameters crystal{row.diameter_nm, 1.45, 1.333};
        EXPECT_EQ(2 * reciprocal_pairs(crystal, 360.0, nullptr, 0) + 1, row.points) << row.diameter_nm;
    }
}

TEST(Crystal, PairsAreUnitShortestFirstAndObeyTheFccRule) {
    const CrystalParameters crystal{350.0, 1.45, 1.333};
    std::vector<PlanePair> pairs(64);
    pairs.resize(std::size_t(reciprocal_pairs(crystal, 360.0, pairs.data(), 64)));
    ASSERT_EQ(pairs.size(), 29u);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        EXPECT_NEAR(length(pairs[i].normal), 1.0f, 1e-6f);
        EXPECT_EQ((pairs[i].h - pairs[i].k) % 2, 0);
        EXPECT_EQ((pairs[i].k - pairs[i].l) % 2, 0);
        if (i > 0) {
            EXPECT_GE(pairs[i].g_per_nm, pairs[i - 1].g_per_nm);
        }
    }
    // |G_111| = 1 / d_111, d_111 = sqrt(2/3) d.
    EXPECT_NEAR(1.0 / double(pairs[0].g_per_nm), std::sqrt(2.0 / 3.0) * 350.0, 1e-3);
}

double width_of(double n_sphere, double n_medium, int h, int k, int l) {
    const CrystalParameters crystal{250.0, n_sphere, n_medium};
    const double g_per_nm = std::sqrt(double(h * h + k * k + l * l)) / (std::sqrt(2.0) * 250.0);
    const double mean_permittivity = fcc_filling * n_sphere * n_sphere + (1.0 - fcc_filling) * n_medium * n_medium;
    return std::abs(permittivity_coefficient(crystal, g_per_nm)) / mean_permittivity;
}

/// Relative widths |eps_G| / (mean eps) in per cent computed beforehand from the spheres' form factor, for silica in water and in
/// air.
TEST(Crystal, StopBandWidthsPerFamily) {
    EXPECT_NEAR(100.0 * width_of(1.45, 1.333, 1, 1, 1), 1.434, 0.001);
    EXPECT_NEAR(100.0 * width_of(1.45, 1.333, 2, 0, 0), 0.090, 0.001);
    EXPECT_NEAR(100.0 * width_of(1.45, 1.333, 2, 2, 0), 0.908, 0.001);
    EXPECT_NEAR(100.0 * width_of(1.45, 1.333, 3, 1, 1), 0.229, 0.001);
    EXPECT_NEAR(100.0 * width_of(1.45, 1.333, 2, 2, 2), 0.018, 0.001);
    EXPECT_NEAR(100.0 * width_of(1.45, 1.333, 4, 0, 0), 0.416, 0.001);
    EXPECT_NEAR(100.0 * width_of(1.45, 1.0, 1, 1, 1), 5.40, 0.01);
}

TEST(Crystal, EffectiveIndex) {
    EXPECT_NEAR(effective_index({250.0, 1.45, 1.333}), 1.41964, 1e-5);
}

}  // namespace
}  // namespace opal
