// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "formats/random.h"
#include "renderer/core/crystal.h"
#include "renderer/core/two_beam.h"

namespace opal {
namespace {

/// The reflectance as printed, in complex double precision.
double exact_reflectance(double kappa_t, double delta_t) {
    const std::complex<double> gamma = std::sqrt(std::complex<double>(kappa_t * kappa_t - delta_t * delta_t, 0.0));
    const std::complex<double> sinh = std::sinh(gamma), cosh = std::cosh(gamma);
    if (std::abs(gamma) < 1e-9) return kappa_t * kappa_t / (1.0 + kappa_t * kappa_t);
    const std::complex<double> r =
        kappa_t * kappa_t * sinh * sinh / (gamma * gamma * cosh * cosh + delta_t * delta_t * sinh * sinh);
    return r.real();
}

TEST(TwoBeam, SineSquaredHasSinglePrecision) {
    double worst = 0.0;
    for (double x = 0.0; x < 40.0; x += 0.0037)
        worst = std::max(worst, std::abs(double(sine_squared(float(x))) - std::pow(std::sin(double(float(x))), 2)));
    EXPECT_LT(worst, 4e-6);
}

TEST(TwoBeam, OddsEqualThePrintedFormula) {
    for (double kappa_t = 0.01; kappa_t < 6.0; kappa_t *= 1.37)
        for (double delta_t = -30.0; delta_t <= 30.0; delta_t += 0.0713) {
            const double odds = double(block_reflection_odds(float(kappa_t), float(delta_t)));
            EXPECT_NEAR(odds / (1.0 + odds), exact_reflectance(double(float(kappa_t)), double(float(delta_t))), 2e-5);
        }
}

TEST(TwoBeam, OddsAreContinuousAtTheBandEdgeAndNeverOverflow) {
    for (const float kappa_t : {0.1f, 1.0f, 3.0f})
        for (float delta_t = 0.99f * kappa_t; delta_t < 1.01f * kappa_t; delta_t += 1e-4f * kappa_t) {
            const float here = block_reflection_odds(kappa_t, delta_t),
                        next = block_reflection_odds(kappa_t, delta_t + 1e-4f * kappa_t);
            EXPECT_NEAR(next / here, 1.0f, 2e-3f);
        }
    EXPECT_TRUE(std::isfinite(block_reflection_odds(1.0e4f, 0.0f)));
}

/// One thick coherent block of (111) planes at normal incidence, s polarization, n_sphere in water.
struct Slab {
    CrystalParameters crystal;
    BeamGeometry beam;

    Slab(double n_sphere, double layers) : crystal{250.0, n_sphere, 1.333} {
        const double g = std::sqrt(3.0) / (std::sqrt(2.0) * crystal.sphere_diameter_nm);
        beam = {1.0f, float(g), float(permittivity_coefficient(crystal, g)), float(effective_index(crystal)), float(layers / g),
                1.0f};
    }
    double reflectance(double wavelength_nm) const {
        const float lanes[num_lanes] = {float(wavelength_nm), float(wavelength_nm), float(wavelength_nm), float(wavelength_nm)};
        PileOdds odds;
        return pile_odds(beam, lanes, odds) ? double(odds.s(0) / (1.0f + odds.s(0))) : 0.0;
    }
};

/// Photonic band solver (MPB 1.11.1, fcc of touching spheres, gap at L): middle of the (111) stop band over the sphere diameter,
/// and its relative width, for the pairs in water.
const struct {
    double n_sphere, lambda_mid_over_d, relative_width;
} band_solver[] = {{1.45, 2.318, 0.0142304}, {1.46, 2.33003, 0.0153341}, {1.42, 2.28184, 0.0108186}};

TEST(TwoBeam, BraggPeaksAgreeWithTheBandSolver) {
    for (const auto& row : band_solver) {
        const Slab slab(row.n_sphere, 60.0);
        double peak_nm = 0.0, highest = 0.0;
        for (double wavelength = 540.0; wavelength < 620.0; wavelength += 0.05)
            if (slab.reflectance(wavelength) > highest) {
                highest = slab.reflectance(wavelength);
                peak_nm = wavelength;
            }
        EXPECT_NEAR(peak_nm / 250.0, row.lambda_mid_over_d, 0.005 * row.lambda_mid_over_d) << row.n_sphere;
    }
}

TEST(TwoBeam, BandWidthsAgreeWithTheBandSolver) {
    for (const auto& row : band_solver) {
        // In a crystal thick against the decay length the reflectance is 1 to single precision inside the band and falls below it
        // at once outside.
        const Slab slab(row.n_sphere, 20000.0);
        double first = 0.0, last = 0.0;
        for (double wavelength = 540.0; wavelength < 620.0; wavelength += 0.002)
            if (slab.reflectance(wavelength) > 0.99999) {
                if (first == 0.0) first = wavelength;
                last = wavelength;
            }
        const double width = (last - first) / (0.5 * (last + first));
        EXPECT_NEAR(width, row.relative_width, 0.02 * row.relative_width) << row.n_sphere;
    }
}

/// A pile of blocks, each reflecting with probability r either way, against a random walk between its two beams.
TEST(TwoBeam, PileEqualsTheRandomWalk) {
    for (const int blocks : {1, 3, 20})
        for (const double r : {0.02, 0.3, 0.8}) {
            const int walks = 40000;
            int reflected = 0;
            for (int walk = 0; walk < walks; ++walk) {
                int position = 0, step = 1;
                std::uint32_t dimension = 0;
                while (position >= 0 && position < blocks) {
                    const RandomBlock block = random_block(7, RandomStream::render_paths, std::uint64_t(walk), dimension++);
                    if (uniform_double(block.value[0], block.value[1]) < r) step = -step;
                    position += step;
                }
                reflected += position < 0 ? 1 : 0;
            }
            const double odds = blocks * r / (1.0 - r), expected = odds / (1.0 + odds);
            EXPECT_NEAR(double(reflected) / walks, expected, 4.0 * std::sqrt(expected * (1.0 - expected) / walks))
                << blocks << " " << r;
        }
}

TEST(TwoBeam, TurningDensityIsTheDerivativeOfTheReflectance) {
    PileOdds odds{};
    odds.odds[0] = 3.7f;
    odds.odds[num_lanes] = 0.2f;
    for (float x = 0.05f; x < 0.95f; x += 0.1f) {
        const double slope = double(odds.reflectance(0, x + 1e-3f) - odds.reflectance(0, x - 1e-3f)) / 2e-3;
        EXPECT_NEAR(slope, double(odds.turning_density(0, x)), 2e-3);
    }
}

TEST(TwoBeam, ShortCrossingsAreOneThinBlock) {
    BeamGeometry beam{0.5f, 0.004f, 0.03f, 1.42f, 0.0f, 0.0f};
    set_blocks(beam, 10000.0f, 25000.0f);
    EXPECT_FLOAT_EQ(beam.block_nm, 5000.0f);
    EXPECT_FLOAT_EQ(beam.blocks, 1.0f);
    set_blocks(beam, 1.0e6f, 25000.0f);
    EXPECT_FLOAT_EQ(beam.block_nm, 25000.0f);
    EXPECT_FLOAT_EQ(beam.blocks, 20.0f);
}

TEST(TwoBeam, NothingIsReflectedFarFromBragg) {
    BeamGeometry beam{0.005f, 0.004f, 0.03f, 1.42f, 0.0f, 0.0f};
    set_blocks(beam, 1.0e6f, 25000.0f);
    const float lanes[num_lanes] = {400.0f, 500.0f, 600.0f, 700.0f};
    PileOdds odds;
    EXPECT_FALSE(pile_odds(beam, lanes, odds));
}

}  // namespace
}  // namespace opal
