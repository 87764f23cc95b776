// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "formats/illuminant.h"

namespace opal {
namespace {

/// The matrix of IEC 61966-2-1, given there to four digits for the white (0.3127, 0.3290): ours differs by the white alone.
TEST(Colorimetry, SrgbPrimariesAreTheStandards) {
    const Xyz red = xyz_from_linear_srgb({1, 0, 0}), green = xyz_from_linear_srgb({0, 1, 0}),
              blue = xyz_from_linear_srgb({0, 0, 1});
    EXPECT_NEAR(red.x, 0.4124, 2e-4);
    EXPECT_NEAR(red.y, 0.2126, 2e-4);
    EXPECT_NEAR(green.y, 0.7152, 2e-4);
    EXPECT_NEAR(green.z, 0.1192, 2e-4);
    EXPECT_NEAR(blue.x, 0.1805, 2e-4);
    EXPECT_NEAR(blue.z, 0.9505, 3e-4);
    EXPECT_NEAR(chromaticity_of(green).x, 0.30, 1e-12);
    EXPECT_NEAR(chromaticity_of(green).y, 0.60, 1e-12);
}

TEST(Colorimetry, WhiteOfSrgbIsD65) {
    const Rgb3d white = linear_srgb_from_xyz(xyz_of(illuminant_spectrum(IlluminantKind::d65)));
    EXPECT_NEAR(white.r, 1.0, 1e-6);
    EXPECT_NEAR(white.g, 1.0, 1e-6);
    EXPECT_NEAR(white.b, 1.0, 1e-6);
    const Rgb3d back = linear_srgb_from_xyz(xyz_from_linear_srgb({0.25, -0.5, 3.0}));
    EXPECT_NEAR(back.r, 0.25, 1e-13);
    EXPECT_NEAR(back.g, -0.5, 1e-13);
    EXPECT_NEAR(back.b, 3.0, 1e-13);
}

/// Worked example of Lindbloom (brucelindbloom.com, "Chromatic Adaptation"): the Bradford matrix from A to D65 for the whites
/// A (1.09850, 1, 0.35585) and D65 (0.95047, 1, 1.08883), to the digits he gives.
TEST(Colorimetry, BradfordAdaptation) {
    const Matrix3 matrix = bradford_adaptation({1.09850, 1.0, 0.35585}, {0.95047, 1.0, 1.08883});
    const double expected[3][3] = {
        {0.8446965, -0.1179225, 0.3948108}, {-0.1366303, 1.1041226, 0.1291718}, {0.0798489, -0.1348999, 3.1924009}};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(matrix[i][j], expected[i][j], 1e-5);
    const Xyz white = matrix * Xyz{1.09850, 1.0, 0.35585};
    EXPECT_NEAR(white.x, 0.95047, 1e-12);
    EXPECT_NEAR(white.z, 1.08883, 1e-12);
}

TEST(Colorimetry, LabOfKnownColors) {
    const Lab white = lab_from_xyz(srgb_white, srgb_white);
    EXPECT_NEAR(white.l, 100.0, 1e-9);
    EXPECT_NEAR(white.a, 0.0, 1e-9);
    // Middle grey of 18.418651851244416 % is L* 50 by definition: ((50 + 16) / 116)^3.
    const Lab grey =
        lab_from_xyz({0.18418651851244416 * srgb_white.x, 0.18418651851244416, 0.18418651851244416 * srgb_white.z}, srgb_white);
    EXPECT_NEAR(grey.l, 50.0, 1e-9);
    // Below the cube root's linear part: L* = 903.2963 Y.
    EXPECT_NEAR(lab_from_xyz({0.0, 0.001, 0.0}, srgb_white).l, 0.9032963, 1e-6);
    EXPECT_NEAR(delta_e_76({50, 3, 4}, {50, 0, 0}), 5.0, 1e-12);
}

/// Pairs of Sharma, Wu and Dalal (2005), table 1, which reach every branch of the formula.
TEST(Colorimetry, ColorDifferenceCiede2000) {
    struct Pair {
        Lab first, second;
        double difference;
    };
    const Pair pairs[] = {{{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
                          {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
                          {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
                          {{50, 0, 0}, {50, -1, 2}, 2.3669},
                          {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0009}, 7.1792},
                          {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0011}, 7.2195},
                          {{50, 2.5, 0}, {50, 0, -2.5}, 4.3065},
                          {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
                          {{50, 2.5, 0}, {61, -5, 29}, 22.8977},
                          {{50, 2.5, 0}, {56, -27, -3}, 31.9030},
                          {{50, 2.5, 0}, {58, 24, 15}, 19.4535},
                          {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
                          {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
                          {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
                          {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
                          {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082}};
    for (const Pair& pair : pairs) {
        EXPECT_NEAR(delta_e_2000(pair.first, pair.second), pair.difference, 0.5e-4);
        EXPECT_NEAR(delta_e_2000(pair.second, pair.first), pair.difference, 0.5e-4);
    }
    EXPECT_EQ(delta_e_2000({50, 3, 4}, {50, 3, 4}), 0.0);
}

/// Standard illuminants: A 2856 K on the locus; D65 6504 K, Duv +0.0032 (CIE 015; ANSI C78.377 gives 6504 K and 0.0032).
TEST(Colorimetry, CorrelatedColorTemperatures) {
    const CorrelatedColorTemperature a = correlated_color_temperature({0.44758, 0.40745});
    EXPECT_NEAR(a.temperature_k, 2856.0, 1.0);
    EXPECT_NEAR(a.duv, 0.0, 2e-5);
    const CorrelatedColorTemperature d65 = correlated_color_temperature({0.31273, 0.32902});
    EXPECT_NEAR(d65.temperature_k, 6504.0, 2.0);
    EXPECT_NEAR(d65.duv, 0.0032, 5e-5);
}

TEST(Colorimetry, SrgbEncoding) {
    EXPECT_NEAR(srgb_encoded(0.002), 0.02584, 1e-9);
    EXPECT_NEAR(srgb_encoded(0.18), 0.46135612950044164, 1e-9);
    EXPECT_NEAR(srgb_encoded(1.0), 1.0, 1e-12);
    for (const double linear : {0.0, 0.002, 0.18, 1.0}) EXPECT_NEAR(srgb_decoded(srgb_encoded(linear)), linear, 1e-12);
}

}  // namespace
}  // namespace opal
