// SPDX-License-Identifier: Apache-2.0
#include "renderer/optics/transfer_matrix.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "formats/units.h"
#include "renderer/optics/reflectance.h"

namespace opal {
namespace {

using Complex = std::complex<double>;

/// Airy's sum over the reflections inside one film between two half spaces (Born & Wolf, section 7.6.1), evanescent waves
/// included.
double airy_reflectance(double n0, double n1, double n2, double thickness_nm, double wavelength_nm, double cosine, bool is_s) {
    const double sine = n0 * std::sqrt(1.0 - cosine * cosine);
    const auto normal = [&](double n) { return std::sqrt(Complex(n * n - sine * sine, 0.0)); };
    const auto amplitude = [&](double a, double b) {
        const Complex qa = is_s ? normal(a) : a * a / normal(a), qb = is_s ? normal(b) : b * b / normal(b);
        return (qa - qb) / (qa + qb);
    };
    const Complex round_trip = std::exp(Complex(0.0, 4.0 * units::pi * thickness_nm / wavelength_nm) * normal(n1));
    const Complex front = amplitude(n0, n1), back = amplitude(n1, n2);
    return std::norm((front + back * round_trip) / (1.0 + front * back * round_trip));
}

TEST(TransferMatrix, OneFilmFollowsAiry) {
    for (const double n0 : {1.0, 1.5})
        for (const double n2 : {1.0, 1.33, 1.7})
            for (const double angle_deg : {0.0, 30.0, 50.0, 75.0})
                for (const Polarization polarization : {Polarization::s, Polarization::p})
                    for (const double n1 : {1.2, 1.45, 2.1}) {
                        const double cosine = std::cos(units::rad_from_deg(angle_deg)),
                                     tangential = n0 * std::sin(units::rad_from_deg(angle_deg));
                        const StackResponse response =
                            stack_response(characteristic_matrix({310.0, n1 * n1}, polarization, 500.0, tangential), polarization,
                                           n0, n2, cosine);
                        EXPECT_NEAR(response.reflectance,
                                    airy_reflectance(n0, n1, n2, 310.0, 500.0, cosine, polarization == Polarization::s), 1e-12)
                            << n0 << " " << n1 << " " << n2 << " " << angle_deg;
                        EXPECT_NEAR(response.reflectance + response.transmittance, 1.0, 1e-12);
                    }
}

/// (H L)^N in front of a substrate: R = ((n0 - Y) / (n0 + Y))^2 with Y = (nH / nL)^(2 N) ns (Born & Wolf, section 1.6.5).
TEST(TransferMatrix, QuarterWaveStackFollowsItsClosedForm) {
    const double high = 2.3, low = 1.38, substrate = 1.52, wavelength_nm = 550.0;
    for (const int pairs : {1, 3, 10}) {
        const auto film = [&](double n) {
            return characteristic_matrix({0.25 * wavelength_nm / n, n * n}, Polarization::s, wavelength_nm, 0.0);
        };
        const StackResponse response = stack_response(power(film(high) * film(low), pairs), Polarization::s, 1.0, substrate, 1.0);
        const double admittance = std::pow(high / low, 2 * pairs) * substrate;
        EXPECT_NEAR(response.reflectance, std::pow((1.0 - admittance) / (1.0 + admittance), 2), 1e-12);
        EXPECT_NEAR(response.transmittance, 4.0 * admittance / std::pow(1.0 + admittance, 2), 1e-12);
    }
}

/// Far into the stop band the wave has decayed by e^-1000 and more: nothing overflows, and all is reflected.
TEST(TransferMatrix, ThickStacksKeepTheirNumbers) {
    const double wavelength_nm = 550.0;
    const auto film = [&](double n) {
        return characteristic_matrix({0.25 * wavelength_nm / n, n * n}, Polarization::p, wavelength_nm, 0.0);
    };
    const StackResponse response = stack_response(power(film(2.3) * film(1.38), 5000), Polarization::p, 1.0, 1.52, 1.0);
    EXPECT_NEAR(response.reflectance, 1.0, 1e-12);
    EXPECT_GE(response.transmittance, 0.0);
    EXPECT_LT(response.transmittance, 1e-300);
}

TEST(TransferMatrix, PowersAreRepeatedProducts) {
    const CharacteristicMatrix one = characteristic_matrix({80.0, 2.1}, Polarization::p, 480.0, 0.4) *
                                     characteristic_matrix({120.0, 1.8}, Polarization::p, 480.0, 0.4);
    CharacteristicMatrix product;
    for (int count = 0; count <= 21; ++count) {
        const CharacteristicMatrix raised = power(one, count);
        EXPECT_NEAR(raised.a, product.a, 1e-12);
        EXPECT_NEAR(raised.b, product.b, 1e-12);
        EXPECT_NEAR(raised.c, product.c, 1e-12);
        EXPECT_NEAR(raised.d, product.d, 1e-12);
        product = product * one;
    }
}

/// A film met at Brewster's angle of both its faces does not reflect p.
TEST(TransferMatrix, NothingPolarizedInThePlaneAtBrewster) {
    const double n = 1.45, angle = std::atan(n);
    for (const double thickness_nm : {100.0, 300.0, 3000.0}) {
        const auto reflectance = [&](Polarization polarization) {
            return stack_response(characteristic_matrix({thickness_nm, n * n}, polarization, 500.0, std::sin(angle)),
                                  polarization, 1.0, 1.0, std::cos(angle))
                .reflectance;
        };
        EXPECT_LT(reflectance(Polarization::p), 1e-24);
        EXPECT_GT(reflectance(Polarization::s), 1e-3);
    }
}

/// Half as thick films, a quarter of the error, down to what the default leaves: 1e-4 of reflectance where the curve is steepest.
TEST(TransferMatrix, SlicingConvergesQuadratically) {
    ReflectanceSetup setup;
    setup.model = ReflectanceModel::transfer_matrix;
    setup.layers = 200.0;
    const auto reflectance = [&](double wavelength_nm, int slices) {
        setup.slices_per_period = slices;
        return reflectance_at(setup, wavelength_nm, 0.9);
    };
    const int standard = ReflectanceSetup{}.slices_per_period;
    for (const double wavelength_nm : {515.0, 518.0, 521.0, 524.0, 527.0}) {
        const auto fine = reflectance(wavelength_nm, 8192), medium = reflectance(wavelength_nm, 256),
                   coarse = reflectance(wavelength_nm, 128);
        EXPECT_NEAR(std::abs(coarse.s - fine.s), 4.0 * std::abs(medium.s - fine.s), 0.1 * std::abs(coarse.s - fine.s) + 1e-8);
        EXPECT_NEAR(std::abs(coarse.p - fine.p), 4.0 * std::abs(medium.p - fine.p), 0.1 * std::abs(coarse.p - fine.p) + 1e-8);
        EXPECT_NEAR(reflectance(wavelength_nm, standard).s, fine.s, 1e-4);
        EXPECT_NEAR(reflectance(wavelength_nm, standard).p, fine.p, 1e-4);
    }
}

/// (222) counts the same slab in half the distances of (111); a slab of a little less than a whole number of periods is
/// continuous with the whole one.
TEST(TransferMatrix, ThicknessIsCountedInTheFamilysOwnPlanes) {
    ReflectanceSetup setup, twice, part;
    setup.model = twice.model = part.model = ReflectanceModel::transfer_matrix;
    setup.layers = 24.0;
    twice.planes = {2, 2, 2};
    twice.layers = 48.0;
    part.layers = 23.999999;
    for (const double wavelength_nm : {300.0, 560.0, 580.0, 600.0}) {
        const double reflectance = reflectance_at(setup, wavelength_nm, 0.95).p;
        EXPECT_NEAR(reflectance_at(twice, wavelength_nm, 0.95).p, reflectance, 1e-9);
        EXPECT_NEAR(reflectance_at(part, wavelength_nm, 0.95).p, reflectance, 1e-5);
    }
    part.layers = 23.5;
    EXPECT_GT(std::abs(reflectance_at(part, 580.0, 1.0).s - reflectance_at(setup, 580.0, 1.0).s), 1e-3);
}

}  // namespace
}  // namespace opal
