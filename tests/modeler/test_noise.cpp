// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "modeler/boundary_noise.h"
#include "modeler/gradient_noise.h"
#include "modeler/simplex_noise.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

using testing_tools::random_point;

struct NamedNoise {
    const char* name;
    double (*once)(const openvdb::Vec3d&, const NoiseSource&, std::uint32_t);
    double (*fractal)(const openvdb::Vec3d&, const NoiseSource&, int);
};

void PrintTo(const NamedNoise& which, std::ostream* stream) {
    *stream << which.name;
}

class Noise : public ::testing::TestWithParam<NamedNoise> {};

INSTANTIATE_TEST_SUITE_P(Kinds, Noise,
                         ::testing::Values(NamedNoise{"gradient", gradient_noise, fractal_noise},
                                           NamedNoise{"simplex", simplex_noise, fractal_simplex_noise}));

TEST_P(Noise, StaysInBoundsAndUsesThem) {
    const openvdb::BBoxd box(openvdb::Vec3d(-50.0), openvdb::Vec3d(50.0));
    for (const int octaves : {1, 4}) {
        double lowest = 0.0, highest = 0.0, sum = 0.0;
        constexpr int count = 20'000;
        for (int n = 0; n < count; ++n) {
            const double value = GetParam().fractal(random_point(box, 1, std::uint64_t(n)), {42}, octaves);
            lowest = std::min(lowest, value);
            highest = std::max(highest, value);
            sum += value;
        }
        EXPECT_GE(lowest, -1.0);
        EXPECT_LE(highest, 1.0);
        EXPECT_LT(lowest, -0.4);
        EXPECT_GT(highest, 0.4);
        EXPECT_NEAR(sum / count, 0.0, 0.02);
    }
}

TEST_P(Noise, SourcesDiffer) {
    const openvdb::Vec3d place(0.3, 4.2, -1.7);
    const auto value = [&](const NoiseSource& source) { return GetParam().once(place, source, 0); };
    const double value0 = value({1, RandomStream::perlin_gradients, 0});
    EXPECT_NE(value0, value({2, RandomStream::perlin_gradients, 0}));
    EXPECT_NE(value0, value({1, RandomStream::simplex_gradients, 0}));
    EXPECT_NE(value0, value({1, RandomStream::perlin_gradients, max_octaves}));
    EXPECT_EQ(value({1, RandomStream::perlin_gradients, 1}), GetParam().once(place, {1}, 1));
}

TEST(GradientNoise, IsZeroOnItsLatticeAndSmoothAcrossCells) {
    for (int n = -3; n <= 3; ++n) EXPECT_EQ(gradient_noise(openvdb::Vec3d(n, 2 - n, 5), {1}, 0), 0.0);
    const double step = 1.0e-6;
    for (const double y : {0.3, 0.8}) {
        const double below = gradient_noise({2.0 - step, y, 0.4}, {1}, 0), at = gradient_noise({2.0, y, 0.4}, {1}, 0);
        const double above = gradient_noise({2.0 + step, y, 0.4}, {1}, 0);
        EXPECT_NEAR((above - at) / step, (at - below) / step, 1e-4);
    }
}

/// The steepest slope seen at the middles of many cells, where the bound is reached by the worst gradients.
TEST(GradientNoise, SlopeStaysBelowItsBound) {
    double steepest = 0.0;
    const double step = 1.0e-5;
    for (int n = 0; n < 60'000; ++n) {
        const openvdb::Vec3d middle(n % 40 + 0.5, n / 40 % 40 + 0.5, n / 1600 + 0.5);
        const double change = gradient_noise(middle + openvdb::Vec3d(step, 0, 0), {3}, 0) - gradient_noise(middle, {3}, 0);
        steepest = std::max(steepest, std::abs(change) / step);
    }
    EXPECT_LT(steepest, gradient_noise_slope);
    EXPECT_GT(steepest, 0.4 * gradient_noise_slope);
}

/// Tetrahedra of the simplex grid meet where two coordinates are equal; the noise and its slope pass through.
TEST(SimplexNoise, IsSmoothAcrossTetrahedra) {
    const openvdb::BBoxd box(openvdb::Vec3d(-20.0), openvdb::Vec3d(20.0));
    const double step = 1.0e-5;
    double change = 0.0;
    for (std::uint64_t n = 0; n < 5'000; ++n) {
        openvdb::Vec3d at = random_point(box, 5, n);
        at[1] = at[0];
        openvdb::Vec3d across(0.0);
        across[int(n % 2)] = step;
        const double before = simplex_noise(at - across, {1}, 0), value = simplex_noise(at, {1}, 0);
        const double after = simplex_noise(at + across, {1}, 0);
        change = std::max(change, std::abs(value - before) / step);
        // The second derivative is bounded, so slopes on both sides differ by a multiple of the step; a jump of 1e-8 would show.
        ASSERT_NEAR(after - value, value - before, 1.0e-8);
    }
    EXPECT_GT(change, 0.5);
}

/// Mean squared difference between places `lag` apart, in the directions of a list, with its standard error from batches of
/// places all over many cells.
struct Variogram {
    double mean, error;
};

Variogram variogram(const NamedNoise& noise, const std::vector<openvdb::Vec3d>& directions, double lag_length) {
    constexpr int batches = 100, points = 4000;
    const openvdb::BBoxd box(openvdb::Vec3d(-500.0), openvdb::Vec3d(500.0));
    double sum = 0.0, squares = 0.0;
    for (int batch = 0; batch < batches; ++batch) {
        double mean = 0.0;
        for (int n = 0; n < points; ++n) {
            const openvdb::Vec3d place = random_point(box, 9, std::uint64_t(batch * points + n));
            const openvdb::Vec3d lag = directions[std::size_t(n) % directions.size()].unit() * lag_length;
            const double difference = noise.once(place + lag, {7}, 0) - noise.once(place, {7}, 0);
            mean += difference * difference / points;
        }
        sum += mean;
        squares += mean * mean;
    }
    const double mean = sum / batches;
    return {mean, std::sqrt((squares / batches - mean * mean) / (batches - 1))};
}

/// With isotropic gradients and a kernel of the distance alone, the mean covariance of simplex noise depends on the distance
/// alone (the sum over the lattice averaged over a cell is an integral over space). Gradient noise prefers its axes, which shows
/// that the test can tell.
TEST(SimplexNoise, PrefersNoDirectionOfItsLattice) {
    const std::vector<openvdb::Vec3d> axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::vector<openvdb::Vec3d> body_diagonals = {{1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};
    const std::vector<openvdb::Vec3d> main_diagonal = {{1, 1, 1}};
    const auto sigmas = [](const Variogram& a, const Variogram& b) {
        return std::abs(a.mean - b.mean) / std::hypot(a.error, b.error);
    };
    const NamedNoise simplex{"simplex", simplex_noise, fractal_simplex_noise};
    const NamedNoise gradient{"gradient", gradient_noise, fractal_noise};
    const Variogram along_axes = variogram(simplex, axes, 0.5);
    EXPECT_LT(along_axes.error, 0.005 * along_axes.mean);
    EXPECT_LT(sigmas(along_axes, variogram(simplex, body_diagonals, 0.5)), 4.0);
    EXPECT_LT(sigmas(along_axes, variogram(simplex, main_diagonal, 0.5)), 4.0);
    const Variogram gradient_axes = variogram(gradient, axes, 1.25),
                    gradient_diagonals = variogram(gradient, body_diagonals, 1.25);
    EXPECT_GT(sigmas(gradient_axes, gradient_diagonals), 4.0);
    EXPECT_NEAR(gradient_axes.mean, 0.1003, 4.0 * gradient_axes.error);
    EXPECT_NEAR(gradient_diagonals.mean, 0.1036, 4.0 * gradient_diagonals.error);
}

const openvdb::BBoxd space(openvdb::Vec3d(-10.0), openvdb::Vec3d(10.0));

TEST(BoundaryNoise, IsThreeFractalNoisesWithinItsAmplitude) {
    const BoundaryNoiseRecipe recipe{0.3, 0.7, 3};
    const BoundaryNoise noise(recipe, 5, space);
    double largest = 0.0;
    for (std::uint64_t n = 0; n < 3'000; ++n) {
        const openvdb::Vec3d x = random_point(space, 2, n);
        const openvdb::Vec3d d = noise.displaced(x) - x;
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            const NoiseSource source{5, RandomStream::boundary_noise, axis * max_octaves};
            ASSERT_NEAR(d[int(axis)], 0.3 * fractal_noise(x / 0.7, source, 3), 1.0e-13);
            largest = std::max(largest, std::abs(d[int(axis)]));
        }
    }
    EXPECT_LE(largest, 0.3);
    EXPECT_GT(largest, 0.15);
}

TEST(BoundaryNoise, ManyPointsGiveTheBitsOfEachAlone) {
    for (const double scale_mm : {0.01, 0.3, 20.0}) {
        const BoundaryNoise noise({0.3, scale_mm, 2}, 5, space);
        std::vector<openvdb::Vec3d> points;
        for (std::uint64_t n = 0; n < 200; ++n) points.push_back(random_point({openvdb::Vec3d(-0.2), openvdb::Vec3d(0.4)}, 2, n));
        const std::vector<openvdb::Vec3d> at_rest = points;
        noise.displace(points);
        for (std::size_t n = 0; n < points.size(); ++n) ASSERT_EQ(points[n], noise.displaced(at_rest[n]));
    }
}

TEST(BoundaryNoise, BallsHoldWhatIsDisplaced) {
    for (const double radius_mm : {0.001, 0.02, 0.1, 1.0}) {
        const BoundaryNoise noise({0.2, 0.5, 2}, 5, space);
        double fill = 0.0;
        for (std::uint64_t n = 0; n < 2'000; ++n) {
            const openvdb::Vec3d centre = random_point(space, 2, n);
            const Ball ball = noise.displaced(Ball{centre, radius_mm});
            const openvdb::Vec3d direction = random_point({openvdb::Vec3d(-1.0), openvdb::Vec3d(1.0)}, 3, n).unit();
            const double away = (noise.displaced(centre + direction * radius_mm) - ball.centre_mm).length();
            ASSERT_LE(away, ball.radius_mm);
            fill = std::max(fill, away / ball.radius_mm);
        }
        EXPECT_GT(fill, 0.3) << radius_mm;
    }
}

TEST(BoundaryNoise, ScaleTooFineForTheShapeIsRefused) {
    const auto message = testing_tools::input_error_of([] {
        BoundaryNoise({0.2, 1.0e-6, 16}, 5, {openvdb::Vec3d(0.0), openvdb::Vec3d(1.0e7)});
    });
    EXPECT_NE(message.find("boundary_noise.scale_mm"), std::string::npos) << message;
}

}  // namespace
}  // namespace opal
