// SPDX-License-Identifier: Apache-2.0
#include "renderer/core/diffraction_models.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>

#include "formats/units.h"
#include "renderer/core/two_beam.h"
#include "renderer/optics/reflectance.h"
#include "renderer/optics/two_beam_block.h"

namespace opal {
namespace {

/// The two-beam reflectance as printed, in complex arithmetic.
double printed_two_beam(double kappa_t, double delta_t) {
    const std::complex<double> gamma = std::sqrt(std::complex<double>(kappa_t * kappa_t - delta_t * delta_t, 0.0));
    const std::complex<double> sinh = std::sinh(gamma), cosh = std::cosh(gamma);
    const std::complex<double> r =
        kappa_t * kappa_t * sinh * sinh / (gamma * gamma * cosh * cosh + delta_t * delta_t * sinh * sinh);
    return r.real();
}

TEST(TwoBeamBlock, EqualsThePrintedFormula) {
    for (double kappa_t = 0.01; kappa_t < 8.0; kappa_t *= 1.37)
        for (double delta_t = -30.0; delta_t <= 30.0; delta_t += 0.0713)
            EXPECT_NEAR(two_beam_reflectance(kappa_t, delta_t), printed_two_beam(kappa_t, delta_t), 1e-11);
}

TEST(TwoBeamBlock, BandEdgeAndExtremes) {
    // At the edge gamma = 0: (kappa t)^2 / (1 + (kappa t)^2).
    for (const double kappa_t : {0.01, 1.0, 30.0}) {
        const double edge = kappa_t * kappa_t / (1.0 + kappa_t * kappa_t);
        EXPECT_NEAR(two_beam_reflectance(kappa_t, kappa_t), edge, 1e-14);
        for (const double off : {-1e-6, -1e-8, 1e-8, 1e-6})
            EXPECT_NEAR(two_beam_reflectance(kappa_t, kappa_t * (1.0 + off)), edge, 1e-3 * edge);
    }
    EXPECT_DOUBLE_EQ(two_beam_reflectance(1.0e5, 0.0), 1.0);
    EXPECT_DOUBLE_EQ(two_beam_reflectance(0.0, 3.0), 0.0);
    EXPECT_DOUBLE_EQ(two_beam_reflectance(0.0, 0.0), 0.0);
}

/// The renderer's single precision is the same function.
TEST(TwoBeamBlock, TheRenderersSinglePrecisionAgrees) {
    for (float kappa_t = 0.01f; kappa_t < 6.0f; kappa_t *= 1.37f)
        for (float delta_t = -30.0f; delta_t <= 30.0f; delta_t += 0.0713f) {
            const double odds = double(block_reflection_odds(kappa_t, delta_t));
            EXPECT_NEAR(odds / (1.0 + odds), two_beam_reflectance(double(kappa_t), double(delta_t)), 2e-5);
        }
}

TEST(Laue, InterferenceIsTheSumOverThePlanes) {
    for (const int layers : {1, 2, 7, 24, 200})
        for (double x = -1.5; x <= 1.5; x += 0.0317) {
            std::complex<double> sum = 0.0;
            for (int plane = 0; plane < layers; ++plane) sum += std::polar(1.0, 2.0 * x * plane);
            EXPECT_NEAR(laue_interference(x, double(layers)), std::norm(sum), 1e-9 * layers * layers);
            EXPECT_NEAR(double(laue_interference(float(x), float(layers))), std::norm(sum), 2e-4 * layers * layers);
        }
    EXPECT_DOUBLE_EQ(laue_interference(0.0, 24.0), 576.0);
    EXPECT_NEAR(laue_interference(1e-5, 24.0), laue_interference(1.4e-4, 24.0), 1e-2);
}

/// Where the beam is hardly weakened, (kappa t)^2 << 1, single scattering and two-beam theory are the same: they part by a term
/// of relative size (kappa t)^2.
TEST(Laue, ThinSlabsEqualTwoBeamTheory) {
    ReflectanceSetup laue;
    laue.layers = 6.0;
    laue.crystal.n_medium = 1.44;
    ReflectanceSetup two_beam = laue;
    laue.model = ReflectanceModel::laue;
    const double bragg_nm = bragg_wavelength_outside_nm(laue.crystal, laue.planes, 0.0);
    for (double ratio = 0.97; ratio <= 1.03; ratio += 0.001) {
        const double a = reflectance_at(laue, ratio * bragg_nm, 1.0).s, b = reflectance_at(two_beam, ratio * bragg_nm, 1.0).s;
        EXPECT_NEAR(a, b, 0.01 * b + 1e-9);
    }
    laue.layers = 1.0e4;
    EXPECT_DOUBLE_EQ(reflectance_at(laue, bragg_nm, 1.0).s, 1.0);
    EXPECT_DOUBLE_EQ(reflectance_at(laue, 0.5 * bragg_nm, 1.0).s, 0.0);
}

TEST(EwaldFresnel, MissIsTheLengthOfTheVectors) {
    for (const double cosine : {1.0, 0.8, 0.5, 0.1})
        for (double ratio = 0.5; ratio <= 1.6; ratio += 0.013) {
            // w in the plane of x and z, G along +z and against w; u = (lambda / n) |G|.
            const double u = 2.0 * cosine * ratio;
            const double length = std::hypot(std::sqrt(1.0 - cosine * cosine), u - cosine);
            EXPECT_NEAR(ewald_miss(ratio - 1.0, cosine), std::abs(length - 1.0), 1e-14);
            EXPECT_NEAR(double(ewald_miss(float(ratio - 1.0), float(cosine))), std::abs(length - 1.0), 1e-6);
        }
}

TEST(EwaldFresnel, ReflectsWithinTheToleranceByTheInterface) {
    const double eta = 1.45 / 1.333;
    // At normal incidence the miss is 2 |lambda / lambda_B - 1|.
    EXPECT_DOUBLE_EQ(ewald_fresnel_reflectance(0.0049, 1.0, eta, 0.01).s, std::pow((1.0 - eta) / (1.0 + eta), 2));
    EXPECT_DOUBLE_EQ(ewald_fresnel_reflectance(0.0051, 1.0, eta, 0.01).s, 0.0);
    EXPECT_LT(ewald_fresnel_reflectance(0.0, 1.0 / std::sqrt(1.0 + eta * eta), eta, 0.01).p, 1e-30);
    EXPECT_DOUBLE_EQ(polarized_fresnel(0.05, 1.0 / eta).s, 1.0);
    EXPECT_NEAR(double(polarized_fresnel(0.6f, float(eta)).p), polarized_fresnel(double(0.6f), double(float(eta))).p, 1e-7);
}

}  // namespace
}  // namespace opal
