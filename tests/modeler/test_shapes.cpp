// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>
#include <limits>

#include "modeler/level_set.h"
#include "modeler/shape.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

using openvdb::Vec3d;
using testing_tools::input_error_of;
using testing_tools::random_point;

/// A patch of surface over the unit square, without poles: pattern search stalls at those.
using Patch = std::function<Vec3d(double u, double v)>;

/// Distance by search: the best of a grid of samples, then of ever smaller neighbourhoods around it.
double searched_distance(const std::vector<Patch>& patches, const Vec3d& point) {
    constexpr int samples = 60;
    double best = std::numeric_limits<double>::infinity();
    for (const Patch& patch : patches) {
        double u = 0.5, v = 0.5, patch_best = std::numeric_limits<double>::infinity();
        for (int i = 0; i <= samples; ++i)
            for (int j = 0; j <= samples; ++j) {
                const double distance = (patch(double(i) / samples, double(j) / samples) - point).length();
                if (distance < patch_best) patch_best = distance, u = double(i) / samples, v = double(j) / samples;
            }
        double step = 1.0 / samples;
        while (step > 1.0e-10) {
            bool improved = false;
            for (const auto& [du, dv] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}) {
                const double next_u = std::clamp(u + du * step, 0.0, 1.0), next_v = std::clamp(v + dv * step, 0.0, 1.0);
                const double distance = (patch(next_u, next_v) - point).length();
                if (distance < patch_best) patch_best = distance, u = next_u, v = next_v, improved = true;
            }
            if (!improved) step *= 0.5;
        }
        best = std::min(best, patch_best);
    }
    return best;
}

/// The unit square onto the square |s| + |t| <= 1.
std::pair<double, double> diamond(double u, double v) {
    return {u + v - 1.0, u - v};
}

/// The upper (side 1) or lower (side -1) half of an ellipsoid, by the octahedral map of directions.
Patch half_ellipsoid(const Vec3d& semi_axes, const Vec3d& centre, double side) {
    return [=](double u, double v) {
        const auto [s, t] = diamond(u, v);
        return centre + semi_axes * Vec3d(s, t, side * std::max(0.0, 1.0 - std::abs(s) - std::abs(t))).unit();
    };
}

Patch elliptical_disk(const Vec3d& semi_axes, const Vec3d& centre) {
    return [=](double u, double v) {
        const auto [s, t] = diamond(u, v);
        const double length = std::hypot(s, t), radius = std::abs(s) + std::abs(t);
        return length == 0.0 ? centre : centre + semi_axes * Vec3d(s, t, 0.0) * (radius / length);
    };
}

void expect_distances(const Shape& shape, const std::function<double(const Vec3d&)>& expected, int count) {
    openvdb::BBoxd box = shape.bounds_mm();
    box.expand(0.3 * box.extents().length());
    for (int n = 0; n < count; ++n) {
        const Vec3d point = random_point(box, 7, std::uint64_t(n));
        EXPECT_NEAR(shape.signed_distance_mm(point), expected(point), 2.0e-6) << point;
        EXPECT_EQ(shape.contains(point), shape.signed_distance_mm(point) < 0.0) << point;
    }
}

std::unique_ptr<Shape> shape_of(ShapeKind kind, std::array<double, 3> size_mm, double girdle_mm = 0.0) {
    ShapeRecipe recipe;
    recipe.kind = kind;
    recipe.size_mm = size_mm;
    recipe.girdle_mm = girdle_mm;
    return make_shape(recipe);
}

TEST(Shapes, EllipsoidDistanceEqualsSearch) {
    for (const std::array<double, 3> size : {std::array{12.0, 9.0, 4.5}, {2.0, 2.0, 8.0}, {5.0, 5.0, 5.0}, {20.0, 1.0, 3.0}}) {
        const auto shape = shape_of(ShapeKind::ellipsoid, size);
        const Vec3d semi_axes = 0.5 * Vec3d(size.data()), centre(0.0, 0.0, 0.5 * size[2]);
        const std::vector<Patch> patches = {half_ellipsoid(semi_axes, centre, 1.0), half_ellipsoid(semi_axes, centre, -1.0)};
        expect_distances(
            *shape,
            [&](const Vec3d& p) {
                const double sign = ((p - centre) / semi_axes).lengthSqr() < 1.0 ? -1.0 : 1.0;
                return sign * searched_distance(patches, p);
            },
            25);
    }
}

TEST(Shapes, EllipsoidDistanceAtSpecialPlaces) {
    const auto shape = shape_of(ShapeKind::ellipsoid, {12.0, 9.0, 4.5});
    const double a = 6.0, b = 4.5, c = 2.25;
    EXPECT_NEAR(shape->signed_distance_mm({0.0, 0.0, c}), -c, 1e-12);  // centre: the shortest axis
    EXPECT_NEAR(shape->signed_distance_mm({a + 2.0, 0.0, c}), 2.0, 1e-12);
    EXPECT_NEAR(shape->signed_distance_mm({0.0, -b, c}), 0.0, 1e-12);
    EXPECT_NEAR(shape->signed_distance_mm({0.0, 0.0, -1.0}), 1.0, 1e-12);
    // On the x axis nearer to the centre than the focal distance: the foot leaves the axis (closed form of the ellipse x, z).
    const double x = 2.0, foot_x = a * a * x / (a * a - c * c);
    const double foot_z = c * std::sqrt(1.0 - foot_x * foot_x / (a * a));
    EXPECT_NEAR(shape->signed_distance_mm({x, 0.0, c}), -std::hypot(x - foot_x, foot_z), 1e-12);
    // Almost in the middle plane: continuous with the case above.
    EXPECT_NEAR(shape->signed_distance_mm({x, 0.0, c + 1e-13}), -std::hypot(x - foot_x, foot_z), 1e-10);
    EXPECT_NEAR(shape->signed_distance_mm({x, 1e-200, c - 1e-200}), -std::hypot(x - foot_x, foot_z), 1e-10);
}

TEST(Shapes, BoxDistanceAtFacesEdgesCorners) {
    const auto shape = shape_of(ShapeKind::box, {4.0, 6.0, 2.0});
    EXPECT_DOUBLE_EQ(shape->signed_distance_mm({0.0, 0.0, 1.0}), -1.0);
    EXPECT_DOUBLE_EQ(shape->signed_distance_mm({1.5, 0.0, 1.0}), -0.5);
    EXPECT_DOUBLE_EQ(shape->signed_distance_mm({5.0, 0.0, 1.0}), 3.0);
    EXPECT_DOUBLE_EQ(shape->signed_distance_mm({5.0, 7.0, 1.0}), 5.0);
    EXPECT_DOUBLE_EQ(shape->signed_distance_mm({4.0, 5.0, -1.0}), 3.0);
}

TEST(Shapes, CabochonDistanceEqualsSearch) {
    const double girdle = 0.7, rounding = 0.5 * girdle;
    const auto shape = shape_of(ShapeKind::cabochon, {12.0, 9.0, 4.5}, girdle);
    const Vec3d semi_axes(6.0 - rounding, 4.5 - rounding, 4.5 - girdle), base(0.0, 0.0, rounding);
    const std::vector<Patch> patches = {half_ellipsoid(semi_axes, base, 1.0), elliptical_disk(semi_axes, base)};
    expect_distances(
        *shape,
        [&](const Vec3d& p) {
            const bool in_core = p.z() > base.z() && ((p - base) / semi_axes).lengthSqr() < 1.0;
            const double distance = searched_distance(patches, p);
            return (in_core ? -distance : distance) - rounding;
        },
        60);
}

TEST(Shapes, BoundsAreTightAndStandOnTheGround) {
    for (const ShapeKind kind : {ShapeKind::ellipsoid, ShapeKind::box, ShapeKind::cabochon}) {
        const auto shape = shape_of(kind, {12.0, 9.0, 4.5}, 0.6);
        const openvdb::BBoxd bounds = shape->bounds_mm();
        EXPECT_TRUE(bounds.extents().eq(Vec3d(12.0, 9.0, 4.5)));
        EXPECT_DOUBLE_EQ(bounds.min().z(), 0.0);
        const double girdle_z = kind == ShapeKind::cabochon ? 0.3 : 2.25;
        for (const Vec3d& touching : {Vec3d(6.0, 0.0, girdle_z), Vec3d(0.0, -4.5, girdle_z), Vec3d(0.0, 0.0, 4.5), Vec3d(0.0)})
            EXPECT_NEAR(shape->signed_distance_mm(touching), 0.0, 1e-12) << touching;
    }
}

TEST(Shapes, CabochonThatIsAllGirdleIsRefused) {
    const auto message = input_error_of([] { shape_of(ShapeKind::cabochon, {4.0, 3.0, 1.0}, 1.0); });
    EXPECT_NE(message.find("girdle_mm"), std::string::npos) << message;
}

TEST(Shapes, LevelSetHoldsExactDistancesInAFullBand) {
    const double h = 0.11;
    for (const ShapeKind kind : {ShapeKind::ellipsoid, ShapeKind::cabochon, ShapeKind::box}) {
        const auto shape = shape_of(kind, {12.0, 9.0, 4.5}, 0.6);
        const auto grid = shape->level_set(h);
        const float band = float(level_set_half_width * h);
        EXPECT_EQ(grid->getName(), "shape");
        EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
        EXPECT_FLOAT_EQ(grid->background(), band);
        openvdb::CoordBBox box({-62, -48, -8}, {62, 48, 48});
        auto values = grid->getConstAccessor();
        for (const openvdb::Coord& voxel : box) {
            const double distance = shape->signed_distance_mm(voxel.asVec3d() * h);
            const float stored = values.getValue(voxel);
            ASSERT_EQ(values.isValueOn(voxel), std::abs(distance) < level_set_half_width * h) << voxel;
            ASSERT_NEAR(stored, std::clamp(distance, -double(band), double(band)), 1e-6) << voxel;
        }
    }
}

TEST(Shapes, LevelSetDoesNotDependOnThreads) {
    const auto shape = shape_of(ShapeKind::cabochon, {12.0, 9.0, 4.5}, 0.6);
    const auto one = testing_tools::with_threads(1, [&] { return shape->level_set(0.07); });
    const auto two = testing_tools::with_threads(2, [&] { return shape->level_set(0.07); });
    EXPECT_TRUE(testing_tools::same_grids(*one, *two));
}

}  // namespace
}  // namespace opal
