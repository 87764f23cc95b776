// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
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

template <int N>
LaneOptics<N> optics_at(const CrystalParameters& crystal, const std::array<double, N>& wavelength_nm) {
    LaneOptics<N> optics{};
    for (int i = 0; i < N; ++i) {
        optics.wavelength_nm[i] = float(wavelength_nm[std::size_t(i)]);
        optics.n_eff[i] = float(effective_index(crystal));
        optics.contrast[i] = float(std::abs(crystal.n_sphere * crystal.n_sphere - crystal.n_medium * crystal.n_medium));
    }
    return optics;
}

/// One thick coherent block of (111) planes at normal incidence, s polarization, n_sphere in water.
struct Slab {
    CrystalParameters crystal;
    BeamBlock beams;
    float block_nm;

    Slab(double n_sphere, double layers) : crystal{250.0, n_sphere, 1.333} {
        const double g = std::sqrt(3.0) / (std::sqrt(2.0) * crystal.sphere_diameter_nm);
        block_nm = float(layers / g);
        beams = single_beam(1.0f, float(g), float(sphere_form_factor(crystal.sphere_diameter_nm, g)), block_nm, false);
    }
    double reflectance(double wavelength_nm) const {
        float rate_per_mm[1][beam_block_size];
        reflection_rates(beams, optics_at<1>(crystal, {wavelength_nm}), 1.0e30f, rate_per_mm);
        const double odds = double(rate_per_mm[0][0]) * double(block_nm) * 1.0e-6;
        return odds / (1.0 + odds);
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

TEST(TwoBeam, SaturationTakesAtMostWhatItSays) {
    // Odds N become N A / (N + A): the reflectance falls by less than 1 / A, whatever it is.
    const Slab slab(1.45, 3000.0);
    const double length_mm = double(slab.block_nm) * 1.0e-6;
    for (double wavelength = 560.0; wavelength < 600.0; wavelength += 0.05) {
        float full[1][beam_block_size], saturated[1][beam_block_size];
        reflection_rates(slab.beams, optics_at<1>(slab.crystal, {wavelength}), 1.0e30f, full);
        reflection_rates(slab.beams, optics_at<1>(slab.crystal, {wavelength}), float(100.0 / length_mm), saturated);
        const double a = double(full[0][0]) * length_mm, b = double(saturated[0][0]) * length_mm;
        const double loss = a / (1.0 + a) - b / (1.0 + b);
        EXPECT_GE(loss, -1e-6);
        EXPECT_LE(loss, 0.01);
    }
}

TEST(TwoBeam, LanesAndFamiliesEqualOneAnother) {
    const Slab slab(1.45, 100.0);
    const std::array<double, 8> wavelengths = {400, 463, 520, 576, 579, 581, 700, 800};
    BeamBlock beams = slab.beams;
    const float cosines[4] = {0.3f, 0.8f, 1.0f, 0.93f};
    for (int j = 0; j < beam_block_size; ++j) {
        beams.cosine[j] = cosines[j % 4];
        beams.polarized[j] = j < 4 ? 1.0f : 0.0f;
        beams.share[j] = 1.0f - 0.1f * float(j);
    }
    float together[8][beam_block_size], alone[1][beam_block_size];
    reflection_rates(beams, optics_at<8>(slab.crystal, wavelengths), 1.0e4f, together);
    for (std::size_t i = 0; i < 8; ++i)
        for (int j = 0; j < beam_block_size; ++j) {
            BeamBlock one = slab.beams;
            for (int k = 0; k < beam_block_size; ++k) {
                one.cosine[k] = beams.cosine[j];
                one.polarized[k] = beams.polarized[j];
                one.share[k] = beams.share[j];
            }
            reflection_rates(one, optics_at<1>(slab.crystal, {wavelengths[i]}), 1.0e4f, alone);
            EXPECT_NEAR(double(together[i][j]), double(alone[0][0]), 2e-5 * double(alone[0][0]));
        }
}

TEST(TwoBeam, NothingIsReflectedFarFromBragg) {
    Slab slab(1.45, 100.0);
    for (float& cosine : slab.beams.cosine) cosine = 0.005f;
    float rate_per_mm[4][beam_block_size];
    reflection_rates(slab.beams, optics_at<4>(slab.crystal, {400.0, 500.0, 600.0, 700.0}), 1.0e30f, rate_per_mm);
    for (const auto& lane : rate_per_mm)
        for (const float rate : lane) EXPECT_EQ(rate, 0.0f);
}

}  // namespace
}  // namespace opal
