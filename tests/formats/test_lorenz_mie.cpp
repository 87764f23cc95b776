// SPDX-License-Identifier: Apache-2.0
#include "formats/lorenz_mie.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "expect_error.h"
#include "formats/units.h"

namespace opal {
namespace {

using Complex = std::complex<double>;

/// One unit in the last of the six decimals that the published tables print.
constexpr double sixth_decimal = 1.0e-6;

struct PublishedCase {
    Complex index;
    double size_parameter, q_sca, asymmetry;
};

/// Test cases 5 to 19 of Wiscombe, "Mie scattering calculations: advances in technique and fast, vector-speed computer codes",
/// NCAR/TN-140+STR, 1979, as the output of his MIEV0 prints them. (0 to 4 are perfect conductors.)
const PublishedCase wiscombe_miev0[] = {
    {{0.75, 0.0}, 0.099, 0.000007, 0.001448},      {{0.75, 0.0}, 0.101, 0.000008, 0.001507},
    {{0.75, 0.0}, 10.0, 2.232265, 0.896473},       {{0.75, 0.0}, 1000.0, 1.997908, 0.844944},
    {{1.33, 1.0e-5}, 1.0, 0.093923, 0.184517},     {{1.33, 1.0e-5}, 100.0, 2.096594, 0.868959},
    {{1.33, 1.0e-5}, 10000.0, 1.723857, 0.907840}, {{1.5, 1.0}, 0.055, 0.000011, 0.000491},
    {{1.5, 1.0}, 0.056, 0.000012, 0.000509},       {{1.5, 1.0}, 1.0, 0.663454, 0.192136},
    {{1.5, 1.0}, 100.0, 1.283697, 0.850252},       {{1.5, 1.0}, 10000.0, 1.236575, 0.846309},
    {{10.0, 10.0}, 1.0, 2.049405, -0.110664},      {{10.0, 10.0}, 100.0, 1.836785, 0.556215},
    {{10.0, 10.0}, 10000.0, 1.795393, 0.548194}};

/// The tables of its appendix, page A22.
const PublishedCase wiscombe_appendix[] = {{{1.5, 0.0}, 10.0, 2.881999, 0.742913},   {{1.5, 0.0}, 100.0, 2.094388, 0.818246},
                                           {{1.5, 0.0}, 1000.0, 2.013945, 0.827882}, {{1.5, 0.0}, 5000.0, 2.008650, 0.829592},
                                           {{1.5, 0.1}, 10.0, 1.235144, 0.922350},   {{1.5, 0.1}, 100.0, 1.132134, 0.950392},
                                           {{1.5, 0.1}, 1000.0, 1.106932, 0.950880}, {{1.5, 0.1}, 5000.0, 1.099193, 0.950650}};

/// Records the case, what was published and what is found, for docs/validation/plot_phase.py.
void expect_published(const std::string& name, const PublishedCase& published) {
    const MieEfficiencies found = mie_efficiencies(mie_coefficients(published.size_parameter, published.index));
    testing::Test::RecordProperty(
        name, fmt::format("{} {} {} {:.6f} {:.6f} {:.9f} {:.9f}", published.index.real(), published.index.imag(),
                          published.size_parameter, published.q_sca, published.asymmetry, found.q_sca, found.asymmetry));
    EXPECT_NEAR(found.q_sca, published.q_sca, sixth_decimal) << published.index << " " << published.size_parameter;
    EXPECT_NEAR(found.asymmetry, published.asymmetry, sixth_decimal) << published.index << " " << published.size_parameter;
}

TEST(LorenzMie, Wiscombe1979) {
    int number = 5;
    for (const PublishedCase& published : wiscombe_miev0) expect_published(fmt::format("miev0_{:02}", number++), published);
    number = 1;
    for (const PublishedCase& published : wiscombe_appendix) expect_published(fmt::format("page_a22_{}", number++), published);
}

/// Small spheres, of which the tables print one digit of Q_sca: 4 Re S(0) / x^2 of the printed amplitudes, and the series in 40
/// digits (mpmath). MIEV0 takes a series of its own below x = 0.1, good to 2e-6.
TEST(LorenzMie, SmallSpheres) {
    const struct {
        double size_parameter, amplitude_miev0, amplitude_40_digits;
    } cases[] = {{0.099, 1.817558e-8, 1.817560929631369e-8}, {0.101, 2.048754e-8, 2.048753066335775e-8}};
    for (const auto& published : cases) {
        const double x = published.size_parameter;
        const double found = 0.25 * x * x * mie_efficiencies(mie_coefficients(x, 0.75)).q_sca;
        EXPECT_NEAR(found, published.amplitude_miev0, 2.0e-6 * published.amplitude_miev0);
        EXPECT_NEAR(found, published.amplitude_40_digits, 1.0e-11 * published.amplitude_40_digits);
    }
}

/// The same cases' extinction where it differs from the scattering, printed with seven digits.
TEST(LorenzMie, WiscombesExtinction) {
    const struct {
        Complex index;
        double size_parameter, q_ext;
    } cases[] = {{{1.33, 1.0e-5}, 1.0, 9.395198e-2}, {{1.33, 1.0e-5}, 100.0, 2.101321}, {{1.33, 1.0e-5}, 10000.0, 2.004089},
                 {{1.5, 1.0}, 0.055, 1.014910e-1},   {{1.5, 1.0}, 0.056, 1.033467e-1},  {{1.5, 1.0}, 1.0, 2.336321},
                 {{1.5, 1.0}, 100.0, 2.097502},      {{1.5, 1.0}, 10000.0, 2.004368},   {{10.0, 10.0}, 1.0, 2.532993},
                 {{10.0, 10.0}, 100.0, 2.071124},    {{10.0, 10.0}, 10000.0, 2.005914}, {{1.5, 0.1}, 10.0, 2.459791},
                 {{1.5, 0.1}, 5000.0, 2.006775}};
    for (const auto& published : cases)
        EXPECT_NEAR(mie_efficiencies(mie_coefficients(published.size_parameter, published.index)).q_ext, published.q_ext,
                    sixth_decimal * published.q_ext)
            << published.index << " " << published.size_parameter;
}

/// MIEV0's amplitudes S1, S2 every 30 degrees. Its time factor is exp(+i omega t): conjugates of ours.
struct PublishedAmplitudes {
    Complex index;
    double size_parameter;
    Complex s1[7], s2[7];
};

const PublishedAmplitudes wiscombe_amplitudes[] = {{{0.75, 0.0},
                                                    0.101,
                                                    {{2.048754e-8, -1.756419e-4},
                                                     {2.048754e-8, -1.755965e-4},
                                                     {2.048753e-8, -1.754726e-4},
                                                     {2.048751e-8, -1.753033e-4},
                                                     {2.048750e-8, -1.751341e-4},
                                                     {2.048749e-8, -1.750103e-4},
                                                     {2.048749e-8, -1.749650e-4}},
                                                    {{2.048754e-8, -1.756419e-4},
                                                     {1.774273e-8, -1.520629e-4},
                                                     {1.024377e-8, -8.771198e-5},
                                                     {1.845057e-15, 3.247270e-8},
                                                     {-1.024375e-8, 8.759147e-5},
                                                     {-1.774269e-8, 1.515715e-4},
                                                     {-2.048749e-8, 1.749650e-4}}},
                                                   {{0.75, 0.0},
                                                    10.0,
                                                    {{55.80662, -9.758097},
                                                     {-7.672879, 10.87317},
                                                     {3.587894, -1.756177},
                                                     {-1.785905, -5.232828e-2},
                                                     {1.537971, -8.329374e-2},
                                                     {-0.4140427, 0.1876851},
                                                     {-1.078568, -3.608807e-2}},
                                                    {{55.80662, -9.758097},
                                                     {-10.92923, 9.629667},
                                                     {3.427411, 8.082691e-2},
                                                     {-0.5148748, -0.7027288},
                                                     {-0.6908338, 0.2152693},
                                                     {0.5247557, -0.1923391},
                                                     {1.078568, 3.608807e-2}}},
                                                   {{1.5, 1.0},
                                                    1.0,
                                                    {{0.5840802, 0.1905153},
                                                     {0.5657020, 0.1871997},
                                                     {0.5175251, 0.1784426},
                                                     {0.4563396, 0.1671665},
                                                     {0.4002117, 0.1566427},
                                                     {0.3621572, 0.1493910},
                                                     {0.3488438, 0.1468286}},
                                                    {{0.5840802, 0.1905153},
                                                     {0.5001610, 0.1456112},
                                                     {0.2879639, 4.105398e-2},
                                                     {3.622847e-2, -6.182646e-2},
                                                     {-0.1748750, -0.1229586},
                                                     {-0.3056823, -0.1438460},
                                                     {-0.3488438, -0.1468286}}},
                                                   {{10.0, 10.0},
                                                    100.0,
                                                    {{5177.811, -26.33811},
                                                     {52.27436, -12.70012},
                                                     {-27.05712, -39.51751},
                                                     {1.008860, 46.63027},
                                                     {-15.05640, 43.33057},
                                                     {-45.10770, 5.199554},
                                                     {-41.45383, -18.21808}},
                                                    {{5177.811, -26.33811},
                                                     {-23.80252, -0.3872567},
                                                     {25.85821, 33.23624},
                                                     {-3.479935, -43.64245},
                                                     {13.60634, -42.38302},
                                                     {44.74564, -5.452513},
                                                     {41.45383, 18.21808}}}};

TEST(LorenzMie, WiscombesAmplitudes) {
    for (const PublishedAmplitudes& published : wiscombe_amplitudes) {
        const MieCoefficients coefficients = mie_coefficients(published.size_parameter, published.index);
        for (int i = 0; i < 7; ++i) {
            const MieAmplitudes found = mie_amplitudes(coefficients, std::cos(units::rad_from_deg(30.0 * i)));
            // One unit in the sixth digit of the larger modulus.
            const double tolerance = 1.0e-6 * std::max(std::abs(published.s1[i]), std::abs(published.s2[i]));
            EXPECT_LT(std::abs(found.s1 - std::conj(published.s1[i])), tolerance) << published.size_parameter << " " << 30 * i;
            EXPECT_LT(std::abs(found.s2 - std::conj(published.s2[i])), tolerance) << published.size_parameter << " " << 30 * i;
        }
    }
}

/// The example of B&H's appendix A: a sphere of radius 0.525 um and index 1.55 in air at 0.6328 um, and elements of its
/// scattering matrix every 18 degrees: S11 over its forward value, the polarization -S12 / S11.
TEST(LorenzMie, BohrenAndHuffmanAppendixA) {
    const MieCoefficients coefficients = mie_coefficients(2.0 * units::pi * 0.525 / 0.6328, 1.55);
    const MieEfficiencies found = mie_efficiencies(coefficients);
    EXPECT_NEAR(found.q_sca, 3.10543, 5.0e-6);
    EXPECT_NEAR(found.q_ext, 3.10543, 5.0e-6);
    EXPECT_NEAR(found.q_back, 2.92534, 5.0e-6);
    const double s11[] = {1.0,         0.356897,    0.355355e-1, 0.574313e-1, 0.125959e-1, 0.124601e-1,
                          0.954239e-2, 0.227421e-2, 0.160243e-1, 0.195254e-1, 0.383189e-1};
    const double polarization[] = {0.0,       -0.0458541, -0.534997, 0.0477927, -0.831996, 0.230462,
                                   -0.756255, -0.239612,  -0.706334, -0.783319, 0.0};
    const double forward = std::norm(mie_amplitudes(coefficients, 1.0).s1);
    for (int i = 0; i <= 10; ++i) {
        const MieAmplitudes at = mie_amplitudes(coefficients, std::cos(units::rad_from_deg(18.0 * i)));
        const double sum = std::norm(at.s1) + std::norm(at.s2);
        EXPECT_NEAR(0.5 * sum / forward, s11[i], 1.0e-6 * std::max(0.1, s11[i])) << 18 * i;
        EXPECT_NEAR((std::norm(at.s1) - std::norm(at.s2)) / sum, polarization[i], 1.0e-6) << 18 * i;
    }
}

TEST(LorenzMie, EnergyIsConservedAndTheOpticalTheoremHolds) {
    for (const double x : {1.0e-3, 0.1, 1.0, 7.3, 200.0, 10000.0})
        for (const Complex index : {Complex(0.69), Complex(0.94), Complex(1.02), Complex(1.45), Complex(1.45, 0.2)}) {
            const MieCoefficients coefficients = mie_coefficients(x, index);
            const MieEfficiencies found = mie_efficiencies(coefficients);
            const double forward = mie_amplitudes(coefficients, 1.0).s1.real();
            EXPECT_NEAR(4.0 * forward / (x * x), found.q_ext, 1.0e-11 * found.q_ext) << x << " " << index;
            if (index.imag() == 0.0)
                EXPECT_NEAR(found.q_sca, found.q_ext, 1.0e-10 * found.q_ext) << x << " " << index;
            else
                EXPECT_GT(found.q_ext, found.q_sca) << x << " " << index;
        }
}

/// Q_sca = 8/3 x^4 |K|^2 (B&H eq. 5.8) with K = (m^2 - 1) / (m^2 + 2), the phase function Rayleigh's; corrections are of order
/// x^2.
TEST(LorenzMie, SmallSpheresScatterAsRayleighSays) {
    const double x = 1.0e-4;
    for (const Complex index : {Complex(0.94), Complex(1.45), Complex(1.45, 0.2)}) {
        const MieCoefficients coefficients = mie_coefficients(x, index);
        const MieEfficiencies found = mie_efficiencies(coefficients);
        const Complex polarizability = (index * index - 1.0) / (index * index + 2.0);
        const double expected = 8.0 / 3.0 * std::pow(x, 4) * std::norm(polarizability);
        EXPECT_NEAR(found.q_sca, expected, 1.0e-7 * expected);
        EXPECT_LT(std::abs(found.asymmetry), 1.0e-7);
        for (const double cosine : {-1.0, -0.3, 0.0, 0.8})
            EXPECT_NEAR(mie_phase_function(coefficients, found.q_sca, cosine), 3.0 / (16.0 * units::pi) * (1.0 + cosine * cosine),
                        1.0e-7);
    }
}

TEST(LorenzMie, PhaseFunctionsAreNormalizedAndHaveTheSeriesMeanCosine) {
    for (const double x : {0.5, 2.0, 20.0, 300.0})
        for (const Complex index : {Complex(0.94), Complex(1.45), Complex(1.45, 0.2)}) {
            const MieCoefficients coefficients = mie_coefficients(x, index);
            const MieEfficiencies found = mie_efficiencies(coefficients);
            // Simpson's rule over the angle, 40 points per lobe.
            const int steps = 2000 + 2 * int(20.0 * x);
            double integral = 0.0, mean = 0.0;
            for (int i = 0; i <= steps; ++i) {
                const double angle = units::pi * i / steps;
                const double weight = (i == 0 || i == steps ? 1.0 : (i % 2 ? 4.0 : 2.0)) * units::pi / (3.0 * steps);
                const double density =
                    2.0 * units::pi * std::sin(angle) * mie_phase_function(coefficients, found.q_sca, std::cos(angle));
                integral += weight * density;
                mean += weight * density * std::cos(angle);
            }
            EXPECT_NEAR(integral, 1.0, 1.0e-6) << x << " " << index;
            EXPECT_NEAR(mean, found.asymmetry, 1.0e-6) << x << " " << index;
        }
}

TEST(LorenzMie, WhatIsNoSphereIsAnError) {
    EXPECT_INPUT_ERROR(mie_coefficients(0.0, 1.5), "size parameter 0 is out of range");
    EXPECT_INPUT_ERROR(mie_coefficients(std::nan(""), 1.5), "size parameter nan is out of range");
    EXPECT_INPUT_ERROR(mie_coefficients(1.0e7, 1.5), "allowed: above 0, to 1e6");
    EXPECT_INPUT_ERROR(mie_coefficients(1.0, Complex(1.5, -0.1)), "relative index 1.5 + -0.1 i is out of range");
    EXPECT_INPUT_ERROR(mie_coefficients(1.0, 0.0), "relative index 0 + 0 i is out of range");
}

}  // namespace
}  // namespace opal
