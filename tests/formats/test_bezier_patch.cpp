// SPDX-License-Identifier: Apache-2.0
#include "formats/bezier_patch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "expect_error.h"
#include "formats/bezier_patch_text.h"
#include "formats/random.h"

namespace opal {
namespace {

BezierPatch random_patch(std::uint64_t seed) {
    BezierPatch patch;
    patch.part = static_cast<int>(seed);
    std::uint64_t index = 0;
    for (auto& row : patch.control_mm)
        for (auto& point : row)
            for (double& coordinate : point) {
                const RandomBlock block = random_block(seed, RandomStream::pixel_scramble, index++, 0);
                coordinate = 10.0 * uniform_double(block.value[0], block.value[1]) - 5.0;
            }
    return patch;
}

/// De Casteljau's construction, first in v, then in u.
double casteljau(const BezierPatch& patch, double u, double v, int axis) {
    const auto curve = [](double a, double b, double c, double d, double t) {
        const auto mix = [t](double p, double q) { return p + t * (q - p); };
        return mix(mix(mix(a, b), mix(b, c)), mix(mix(b, c), mix(c, d)));
    };
    double row[4];
    for (int i = 0; i < 4; ++i) {
        const auto& p = patch.control_mm[i];
        row[i] = curve(p[0][axis], p[1][axis], p[2][axis], p[3][axis], v);
    }
    return curve(row[0], row[1], row[2], row[3], u);
}

TEST(BezierPatch, EvaluatesAsDeCasteljauDoes) {
    const BezierPatch patch = random_patch(1);
    const double step = 1.0e-5;
    for (const double u : {0.0, 0.2, 0.5, 0.83, 1.0})
        for (const double v : {0.0, 0.31, 0.5, 0.9, 1.0}) {
            const BezierPoint point = evaluate_bezier(patch, u, v);
            double along_u = 0.0, along_v = 0.0, length2 = 0.0;
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_NEAR(point.position_mm[axis], casteljau(patch, u, v, axis), 1e-13);
                // Central differences of a cubic: off by step^2 times its third derivative / 6, here below 1e-7.
                const double du = (casteljau(patch, u + step, v, axis) - casteljau(patch, u - step, v, axis)) / (2.0 * step);
                const double dv = (casteljau(patch, u, v + step, axis) - casteljau(patch, u, v - step, axis)) / (2.0 * step);
                EXPECT_NEAR(point.du_mm[axis], du, 2e-7);
                EXPECT_NEAR(point.dv_mm[axis], dv, 2e-7);
                along_u += point.normal[axis] * point.du_mm[axis];
                along_v += point.normal[axis] * point.dv_mm[axis];
                length2 += point.normal[axis] * point.normal[axis];
            }
            EXPECT_NEAR(along_u, 0.0, 1e-12);
            EXPECT_NEAR(along_v, 0.0, 1e-12);
            EXPECT_NEAR(length2, 1.0, 1e-14);
        }
}

TEST(BezierPatch, WeightsReverseBitByBit) {
    for (int n = 0; n <= 37; ++n) {
        const double t = n / 37.0, s = (37 - n) / 37.0;
        const BernsteinWeights forth(s, t), back(t, s);
        for (int i = 0; i < 4; ++i) EXPECT_EQ(forth.value[i], back.value[3 - i]);
    }
}

TEST(BezierPatch, NormalAtACollapsedEdgeIsItsLimit) {
    // Each of the four edges in turn becomes a pole.
    for (int edge = 0; edge < 4; ++edge) {
        BezierPatch patch = random_patch(2);
        for (int n = 0; n < 4; ++n)
            for (int axis = 0; axis < 3; ++axis) {
                const int side = edge % 2 == 0 ? 0 : 3;
                (edge < 2 ? patch.control_mm[side][n] : patch.control_mm[n][side])[axis] = axis + 1.0;
            }
        for (const double t : {0.1, 0.5, 0.8}) {
            const double near = 1.0e-6, at = edge % 2 == 0 ? 0.0 : 1.0, inside = edge % 2 == 0 ? near : 1.0 - near;
            const BezierPoint pole = edge < 2 ? evaluate_bezier(patch, at, t) : evaluate_bezier(patch, t, at);
            const BezierPoint beside = edge < 2 ? evaluate_bezier(patch, inside, t) : evaluate_bezier(patch, t, inside);
            for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(pole.normal[axis], beside.normal[axis], 1e-4) << edge << ' ' << t;
        }
    }
}

TEST(BezierPatch, TextReadsBackToTheSameBits) {
    const std::vector<BezierPatch> patches = {random_patch(3), random_patch(4)};
    const std::vector<BezierPatch> read = bezier_patches_from_text(bezier_patches_to_text(patches));
    ASSERT_EQ(read.size(), 2u);
    for (std::size_t n = 0; n < 2; ++n) {
        EXPECT_EQ(read[n].part, patches[n].part);
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j)
                for (int axis = 0; axis < 3; ++axis) ASSERT_EQ(read[n].control_mm[i][j][axis], patches[n].control_mm[i][j][axis]);
    }
}

TEST(BezierPatch, BrokenTextIsRefusedNamingTheLine) {
    const std::string good = bezier_patches_to_text({random_patch(5)});
    for (const std::string& bad : {good + "0 1 2 3\n", good + good.substr(0, good.size() - 1) + " 7\n", good + "x" + good})
        EXPECT_INPUT_ERROR(bezier_patches_from_text(bad), "line 2");
}

}  // namespace
}  // namespace opal
