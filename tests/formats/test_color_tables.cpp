// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "formats/cie_tables.h"
#include "formats/rgb_basis.h"

namespace opal {
namespace {

/// Sums of the 1 nm table over 360-830 nm as published with the standard observer (CIE 015).
TEST(ColorTables, ObserverSums) {
    double x = 0.0, y = 0.0, z = 0.0;
    for (const CieObserverRow& row : cie_1931_observer) {
        x += double(row.x);
        y += double(row.y);
        z += double(row.z);
    }
    EXPECT_NEAR(x, 106.8655, 2e-4);
    EXPECT_NEAR(y, 106.8569, 2e-4);
    EXPECT_NEAR(z, 106.8923, 2e-4);
}

double d65_at(int wavelength_nm) {
    const int i = (wavelength_nm - 300) / 5;
    if (wavelength_nm % 5 == 0) return double(cie_d65_5nm[i]);
    const double t = (wavelength_nm % 5) / 5.0;
    return (1.0 - t) * double(cie_d65_5nm[i]) + t * double(cie_d65_5nm[i + 1]);
}

/// Chromaticity of D65 for the 2-degree observer: 0.31273, 0.32902.
TEST(ColorTables, D65Chromaticity) {
    double x = 0.0, y = 0.0, z = 0.0;
    for (int i = 0; i < 471; ++i) {
        x += double(cie_1931_observer[i].x) * d65_at(360 + i);
        y += double(cie_1931_observer[i].y) * d65_at(360 + i);
        z += double(cie_1931_observer[i].z) * d65_at(360 + i);
    }
    EXPECT_NEAR(x / (x + y + z), 0.31273, 1e-5);
    EXPECT_NEAR(y / (x + y + z), 0.32902, 1e-5);
}

TEST(ColorTables, BasisSumsToOneAndStaysInside) {
    for (int i = 0; i < 48; ++i) {
        double sum = 0.0;
        for (const auto& primary : rgb_basis_10nm) {
            EXPECT_GE(primary[i], 0.0f);
            EXPECT_LE(primary[i], 1.0f);
            sum += double(primary[i]);
        }
        EXPECT_NEAR(sum, 1.0, 1e-6);
    }
}

}  // namespace
}  // namespace opal
