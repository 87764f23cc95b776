// SPDX-License-Identifier: Apache-2.0
#include "renderer/optics/plane_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "formats/units.h"

namespace opal {
namespace {

const PlaneFamily families[] = {{1, 1, 1}, {2, 0, 0}, {2, 2, 0}, {3, 1, 1}, {2, 2, 2}, {4, 0, 0}, {3, 3, 1}, {-1, 1, 3}};

TEST(PlaneProfile, ItsMeanIsTheMeanPermittivity) {
    for (const double filling : {fcc_filling, 0.5})
        for (const PlaneFamily& planes : families) {
            CrystalOptics crystal;
            crystal.filling = filling;
            double sum = 0.0;
            for (const Film& film : plane_averaged_period(crystal, planes, 500.0, 64)) sum += film.permittivity / 64.0;
            EXPECT_NEAR(sum, crystal.mean_permittivity(500.0), 1e-12) << planes.h << planes.k << planes.l;
        }
}

/// The Fourier coefficient of the averaged profile at G is that of the crystal: averaging over the planes loses nothing that G
/// sees. Two ways to the same number, geometry of slices of balls and the sphere's form factor.
TEST(PlaneProfile, ItsFourierCoefficientIsTheFormFactors) {
    for (const double filling : {fcc_filling, 0.5})
        for (const PlaneFamily& planes : families) {
            CrystalOptics crystal;
            crystal.filling = filling;
            constexpr int slices = 4096;
            const auto period = plane_averaged_period(crystal, planes, 500.0, slices);
            std::complex<double> sum = 0.0;
            for (int i = 0; i < slices; ++i)
                sum += period[std::size_t(i)].permittivity / slices *
                       std::polar(1.0, 2.0 * units::pi * planes.order() * ((i + 0.5) / slices - 0.5));
            EXPECT_NEAR(sum.real(), permittivity_coefficient(crystal, planes, 500.0), 1e-6) << planes.h << planes.k << planes.l;
            EXPECT_NEAR(sum.imag(), 0.0, 1e-12);
        }
}

/// A slab of whole spheres holds as much of them as it has planes, wherever the films lie.
TEST(PlaneProfile, WholeSpheresAreAllThere) {
    const CrystalOptics crystal;
    for (const PlaneFamily& planes : families) {
        const double plane_nm = planes.order() / planes.g_per_nm(crystal);
        double excess_nm = 0.0, depth_nm = 0.0;
        for (const Film& film : plane_averaged_slab(crystal, planes, 500.0, 5, 37)) {
            excess_nm += film.thickness_nm * (film.permittivity - 1.333 * 1.333);
            depth_nm += film.thickness_nm;
        }
        EXPECT_NEAR(depth_nm, 4.0 * plane_nm + crystal.sphere_diameter_nm, 1e-9);
        EXPECT_NEAR(excess_nm, 5.0 * plane_nm * (crystal.mean_permittivity(500.0) - 1.333 * 1.333), 1e-9);
    }
}

TEST(PlaneProfile, TouchingSpheresInTheirDensestPlanes) {
    const CrystalOptics crystal;
    const double d = crystal.sphere_diameter_nm;
    // Through the centres of (111) planes discs of diameter d on a triangular lattice: pi / (2 sqrt 3).
    EXPECT_NEAR(plane_filling(crystal, {1, 1, 1}, -1e-4 * d, 1e-4 * d), units::pi / (2.0 * std::sqrt(3.0)), 1e-6);
    // Through the centres of (200) planes on a square lattice: pi / 4.
    EXPECT_NEAR(plane_filling(crystal, {2, 0, 0}, -1e-4 * d, 1e-4 * d), units::pi / 4.0, 1e-6);
}

TEST(PlaneProfile, OrdersOfFcc) {
    EXPECT_EQ((PlaneFamily{1, 1, 1}.order()), 1);
    EXPECT_EQ((PlaneFamily{2, 0, 0}.order()), 1);
    EXPECT_EQ((PlaneFamily{2, 2, 0}.order()), 1);
    EXPECT_EQ((PlaneFamily{2, 2, 2}.order()), 2);
    EXPECT_EQ((PlaneFamily{4, 0, 0}.order()), 2);
    EXPECT_EQ((PlaneFamily{3, 3, 3}.order()), 3);
    EXPECT_FALSE((PlaneFamily{1, 0, 0}.allowed()));
    EXPECT_FALSE((PlaneFamily{2, 1, 1}.allowed()));
    EXPECT_FALSE((PlaneFamily{0, 0, 0}.allowed()));
    EXPECT_TRUE((PlaneFamily{-1, 1, 3}.allowed()));
}

}  // namespace
}  // namespace opal
