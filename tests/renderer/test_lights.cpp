// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "chi_square.h"
#include "formats/illuminant.h"
#include "formats/units.h"
#include "renderer/host/environment_map.h"
#include "renderer/host/light_data.h"

/// Lights' samplers against their densities, and the irradiance that they give against closed forms.
namespace opal {
namespace {

LightDescription rectangle(double distance_mm) {
    LightDescription light;
    light.position_mm = {4.0, -3.0, distance_mm};
    light.target_mm = {1.0, -3.0, 0.0};
    light.width_mm = 14.0;
    light.height_mm = 6.0;
    light.up = {0.0, 1.0, 0.1};
    light.radiance = 1.0;
    return light;
}

LightDescription of_kind(LightKind kind, std::array<double, 3> position_mm, double radius_mm) {
    LightDescription light;
    light.kind = kind;
    light.disk = true;
    light.position_mm = position_mm;
    light.radius_mm = radius_mm;
    light.radiance = 1.0;
    return light;
}

/// Directions from the origin to a flat light, by where they meet it: density per area.
::testing::AssertionResult check_flat(const std::string& name, const LightDescription& description) {
    const LightData data({description}, Upsampling::basis, 0.0f);
    const LightGeometry light = data.view().lights[0].geometry;
    const Frame frame(light.normal);
    const bool is_rectangle = light.shape == LightShape::rectangle;
    const Vec3 x = is_rectangle ? normalize(light.half_x) : frame.tangent,
               y = is_rectangle ? normalize(light.half_y) : frame.bitangent;
    const double half_x = double(is_rectangle ? length(light.half_x) : light.radius_mm) * 1.00001;
    const double half_y = double(is_rectangle ? length(light.half_y) : light.radius_mm) * 1.00001;
    return check_sampler(
        name, SamplerDomain<2>{{-half_x, -half_y}, {half_x, half_y}, {24, 24}},
        [&](SamplerRandom& random) {
            const float u1 = random.next();
            const LightDirection drawn = sample_light_direction(light, {}, u1, random.next());
            const Vec3 place = drawn.distance_mm * drawn.direction - light.position;
            return SamplerPoint<2>{double(dot(place, x)), double(dot(place, y))};
        },
        [&](SamplerPoint<2> p) {
            const Vec3 place = light.position + float(p[0]) * x + float(p[1]) * y;
            const double distance_mm = double(length(place));
            const Vec3 direction = normalize(place);
            if (light_distance(light, {{}, direction}) < 0.0f) return 0.0;
            return double(light_direction_pdf(light, {}, direction)) * -double(dot(direction, light.normal)) /
                   (distance_mm * distance_mm);
        });
}

/// Over the share of 1 - cos and the angle about the axis.
::testing::AssertionResult check_round(const std::string& name, const LightDescription& description) {
    const LightData data({description}, Upsampling::basis, 0.0f);
    const LightGeometry light = data.view().lights[0].geometry;
    const bool sun = light.shape == LightShape::sun;
    const Vec3 axis = sun ? -light.normal : normalize(light.position);
    const float largest = sun ? light.sun_one_minus_cos : sphere_one_minus_cosine(light, {});
    const Frame frame(axis);
    return check_sampler(
        name, SamplerDomain<2>{{0.0, -units::pi}, {1.00001, units::pi}, {24, 24}},
        [&](SamplerRandom& random) {
            const float u1 = random.next();
            const Vec3 d = sample_light_direction(light, {}, u1, random.next()).direction;
            return SamplerPoint<2>{std::min(1.0, double(one_minus_cosine(d, axis) / largest)),
                                   std::atan2(double(dot(d, frame.bitangent)), double(dot(d, frame.tangent)))};
        },
        [&](SamplerPoint<2> p) { return p[0] > 1.0 ? 0.0 : double(light_direction_pdf(light, {}, axis)) * double(largest); });
}

TEST(Lights, DirectionsFollowTheirDensities) {
    EXPECT_TRUE(check_flat("rectangle nearby", rectangle(5.0)));
    EXPECT_TRUE(check_flat("rectangle grazing", [] {
        LightDescription light = rectangle(9.0);
        light.target_mm = {-20.0, -3.0, 9.0};
        light.position_mm = {2.0, -3.0, 9.5};
        light.up = {0.0, 0.0, 1.0};
        return light;
    }()));
    EXPECT_TRUE(check_flat("rectangle far away", rectangle(400.0)));
    // Large, 4 mm beyond its edge, 2 mm above its plane; the same 0.02 mm above; and 2 mm over its middle.
    LightDescription floor = rectangle(0.0);
    floor.width_mm = 100.0;
    floor.height_mm = 40.0;
    const auto seen_from = [&](double x_mm, double height_mm) {
        floor.position_mm = {x_mm, 3.0, -height_mm};
        floor.target_mm = {x_mm, 3.0, 10.0};
        floor.up = {0.0, 1.0, 0.0};
        return floor;
    };
    EXPECT_TRUE(check_flat("large rectangle beside", seen_from(54.0, 2.0)));
    EXPECT_TRUE(check_flat("large rectangle nearly in its plane", seen_from(54.0, 0.02)));
    EXPECT_TRUE(check_flat("large rectangle beneath", seen_from(2.0, 2.0)));
    EXPECT_TRUE(check_flat("disk", of_kind(LightKind::area, {2.0, 3.0, 6.0}, 4.0)));
    EXPECT_TRUE(check_round("sphere nearby", of_kind(LightKind::sphere, {2.0, 3.0, 6.0}, 5.0)));
    EXPECT_TRUE(check_round("small sphere", of_kind(LightKind::sphere, {20.0, 3.0, 100.0}, 0.5)));
    LightDescription sun;
    sun.kind = LightKind::sun;
    sun.angular_diameter_deg = 20.0;
    EXPECT_TRUE(check_round("sun", sun));
}

TEST(Lights, RectangleSolidAngleIsThatOfItsClosedForm) {
    // Centred, 2 a by 2 b at distance d: 4 arcsin(a b / sqrt((a^2 + d^2) (b^2 + d^2))).
    LightDescription description = rectangle(5.0);
    description.position_mm = {0.0, 0.0, 5.0};
    description.target_mm = {0.0, 0.0, 0.0};
    description.up = {0.0, 1.0, 0.0};
    const LightData data({description}, Upsampling::basis, 0.0f);
    const double a = 7.0, b = 3.0, d = 5.0;
    const double expected = 4.0 * std::asin(a * b / std::sqrt((a * a + d * d) * (b * b + d * d)));
    EXPECT_NEAR(seen_rectangle(data.view().lights[0].geometry, {}).solid_angle(), expected, 2.0e-6);
}

/// By Girard's theorem, from the angles between the planes through the point and the edges, in long double.
long double girard(const Vec3& centre, const Vec3& half_x, const Vec3& half_y) {
    using Vector = std::array<long double, 3>;
    const auto cross = [](const Vector& a, const Vector& b) {
        return Vector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const auto dot = [](const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    std::array<Vector, 4> corner;
    for (int k = 0; k < 4; ++k) {
        const long double x = k == 0 || k == 3 ? -1.0L : 1.0L, y = k < 2 ? -1.0L : 1.0L;
        corner[std::size_t(k)] = {centre.x + x * half_x.x + y * half_y.x, centre.y + x * half_x.y + y * half_y.y,
                                  centre.z + x * half_x.z + y * half_y.z};
    }
    long double sum = -2.0L * std::acos(-1.0L);
    for (std::size_t k = 0; k < 4; ++k) {
        const Vector &a = corner[(k + 3) % 4], &b = corner[k], &c = corner[(k + 1) % 4];
        const Vector ab = cross(b, a), cb = cross(b, c), both = cross(ab, cb);
        sum += std::atan2(std::sqrt(dot(both, both)), dot(ab, cb));
    }
    return sum;
}

/// Random rectangles and points, down to 1e-5 of the distance above the rectangle's plane, beside it and in front of it; lengths
/// over six orders of magnitude. The edges are along axes, so that they are at right angles to the last bit.
TEST(Lights, RectangleSolidAnglesAgreeWithLongDouble) {
    double smallest = 1.0;
    for (std::uint64_t i = 0; i < 20'000; ++i) {
        SamplerRandom random{i};
        const auto size = [&](float decades) { return std::pow(10.0f, decades * (random.next() - 0.5f)); };
        const float half_x = size(4.0f), half_y = size(4.0f), height = size(2.0f) * (half_x + half_y);
        const float grazing = i % 2 == 0 ? 1.0f : std::pow(10.0f, -5.0f * random.next());
        const Vec3 centre{(4.0f * random.next() - 2.0f) * (half_x + height), (4.0f * random.next() - 2.0f) * (half_y + height),
                          (random.next() < 0.5f ? -1.0f : 1.0f) * grazing * height};
        const Vec3 x{half_x, 0.0f, 0.0f}, y{0.0f, half_y, 0.0f};
        const double expected = double(girard(centre, x, y)), found = SphericalRectangle(centre, x, y, {}).solid_angle();
        // The reference cancels from 2 pi: good to 1e-18.
        EXPECT_NEAR(found, expected, 1.0e-6 * expected + 1.0e-16) << i;
        smallest = std::min(smallest, expected);
    }
    EXPECT_LT(smallest, 1.0e-9);
}

/// What a drawn direction meets is the rectangle, at the distance told.
TEST(Lights, DrawnDirectionsMeetRectanglesAtTheirDistance) {
    int drawn = 0;
    for (std::uint64_t i = 0; i < 20'000; ++i) {
        SamplerRandom random{i};
        const Vec3 x{30.0f * random.next() + 0.1f, 0.0f, 0.0f}, y{0.0f, 30.0f * random.next() + 0.1f, 0.0f};
        const float height = std::pow(10.0f, -4.0f * random.next()) * 10.0f;
        const Vec3 centre{80.0f * random.next() - 40.0f, 80.0f * random.next() - 40.0f, height};
        const SphericalRectangle seen(centre, x, y, {});
        if (!seen.worth_drawing()) continue;
        ++drawn;
        float distance_mm = 0.0f;
        const float u = random.next(), v = random.next();
        const Vec3 place = [&] {
            const Vec3 direction = seen.direction(u, v, distance_mm);
            EXPECT_NEAR(length(direction), 1.0f, 1.0e-6f);
            return distance_mm * direction - centre;
        }();
        EXPECT_NEAR(place.z, 0.0f, 1.0e-6f * distance_mm) << i;
        EXPECT_LE(std::abs(place.x), x.x + 1.0e-6f * distance_mm) << i;
        EXPECT_LE(std::abs(place.y), y.y + 1.0e-6f * distance_mm) << i;
    }
    EXPECT_GT(drawn, 10'000);
}

/// Irradiance at the origin on a plane that faces up, from `draws` directions: mean and standard error.
std::pair<double, double> irradiance(const LightsView& lights, const EnvironmentView& environment, int draws) {
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < draws; ++i) {
        SamplerRandom random{std::uint64_t(i)};
        const float u = random.next(), u1 = random.next(), u2 = random.next();
        const LightSample sample = sample_light(lights, environment, {}, u, u1, u2);
        double value = 0.0;
        if (sample.pdf > 0.0f && sample.light >= 0) {
            EXPECT_NEAR(light_pdf(lights, environment, {}, sample.direction, sample.light), sample.pdf, 1.0e-3f * sample.pdf);
            const LightView& light = lights.lights[sample.light];
            if (!lights_occlude(lights, {{}, sample.direction}, sample.distance_mm, sample.light))
                value = double(max_of(0.0f, sample.direction.z) * light_falloff(light, -sample.direction) * light.luminance /
                               sample.pdf);
        }
        sum += value;
        squares += value * value;
    }
    const double mean = sum / draws;
    return {mean, std::sqrt((squares / draws - mean * mean) / draws)};
}

TEST(Lights, IrradianceHasItsClosedForms) {
    EnvironmentDescription dark;
    dark.kind = EnvironmentKind::constant;
    const EnvironmentMap environment = make_environment(dark);
    const auto expect = [&](const std::vector<LightDescription>& lights, double expected, const char* what) {
        // The environment is dark, but drawn now and then.
        const LightData data(lights, Upsampling::basis, 1.0e-4f);
        const auto [mean, error] = irradiance(data.view(), environment.view(), 400'000);
        EXPECT_NEAR(mean, expected, 4.0 * error + 1.0e-5 * expected) << what;
        EXPECT_LT(error, 0.01 * expected) << what;
    };
    // Sphere above the horizon: pi (r/d)^2 cos.
    const double d2 = 4.0 + 9.0 + 36.0;
    expect({of_kind(LightKind::sphere, {2.0, 3.0, 6.0}, 4.0)}, units::pi * 16.0 / d2 * 6.0 / std::sqrt(d2), "sphere");
    // Disk above, facing down: pi r^2 / (r^2 + h^2).
    LightDescription disk = of_kind(LightKind::area, {0.0, 0.0, 5.0}, 3.0);
    expect({disk}, units::pi * 9.0 / (9.0 + 25.0), "disk");
    // A rectangle above, facing down, with one corner over the point (a = width/h, b = height/h):
    // (a / sqrt(1+a^2) atan(b / sqrt(1+a^2)) + b / sqrt(1+b^2) atan(a / sqrt(1+b^2))) / 2.
    LightDescription corner = rectangle(5.0);
    corner.position_mm = {7.0, 3.0, 5.0};
    corner.target_mm = {7.0, 3.0, 0.0};
    corner.up = {0.0, 1.0, 0.0};
    const double a = 14.0 / 5.0, b = 6.0 / 5.0, ra = std::sqrt(1.0 + a * a), rb = std::sqrt(1.0 + b * b);
    expect({corner}, 0.5 * (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb)), "rectangle");
    LightDescription far_corner = corner;
    far_corner.position_mm[2] = 200.0;
    const double fa = 14.0 / 200.0, fb = 6.0 / 200.0, fra = std::sqrt(1.0 + fa * fa), frb = std::sqrt(1.0 + fb * fb);
    expect({far_corner}, 0.5 * (fa / fra * std::atan(fb / fra) + fb / frb * std::atan(fa / frb)), "rectangle far away");
    // The sun's irradiance is given on a surface that faces it.
    LightDescription sun;
    sun.kind = LightKind::sun;
    sun.elevation_deg = 30.0;
    expect({sun}, units::pi * 0.5, "sun");
    // A spot straight above shines on its axis as the disk it is.
    LightDescription spot = disk;
    spot.kind = LightKind::spot;
    spot.radius_mm = 0.05;
    expect({spot}, units::pi * 0.0025 / (0.0025 + 25.0), "spot");
    // Together; the small disk hides nothing of the sphere.
    LightDescription low = of_kind(LightKind::sphere, {20.0, 0.0, 8.0}, 2.0);
    const double e2 = 400.0 + 64.0;
    expect({disk, low, sun}, units::pi * (9.0 / 34.0 + 4.0 / e2 * 8.0 / std::sqrt(e2) + 0.5), "disk, sphere and sun");
}

TEST(Lights, ShineOneWayAndStopRays) {
    LightDescription disk = of_kind(LightKind::area, {0.0, 0.0, 5.0}, 3.0);
    LightDescription hidden = of_kind(LightKind::sphere, {0.0, 0.0, 20.0}, 3.0);
    hidden.visible = false;
    const LightData data({disk, hidden}, Upsampling::basis, 0.0f);
    const LightsView lights = data.view();
    LightHit hit;
    ASSERT_TRUE(intersect_lights(lights, {{}, {0, 0, 1}}, 1.0e9f, false, hit));
    EXPECT_EQ(hit.light, 0);
    EXPECT_TRUE(hit.shines);
    EXPECT_FLOAT_EQ(hit.distance_mm, 5.0f);
    EXPECT_FALSE(intersect_lights(lights, {{}, {0, 0, 1}}, 4.0f, false, hit));
    ASSERT_TRUE(intersect_lights(lights, {{0, 0, 10}, {0, 0, -1}}, 1.0e9f, false, hit));
    EXPECT_EQ(hit.light, 0);
    EXPECT_FALSE(hit.shines);
    EXPECT_FALSE(intersect_lights(lights, {{0, 0, 6}, {0, 0, 1}}, 1.0e9f, true, hit));
    ASSERT_TRUE(intersect_lights(lights, {{0, 0, 6}, {0, 0, 1}}, 1.0e9f, false, hit));
    EXPECT_FLOAT_EQ(hit.distance_mm, 11.0f);
    EXPECT_EQ(light_pdf(lights, {}, {0, 0, 6}, {0, 0, -1}, 0), 0.0f);
    EXPECT_TRUE(lights_occlude(lights, {{}, {0, 0, 1}}, 17.0f, 1));
}

/// The spot's cone: full inside, dark outside, and colour times illuminant.
TEST(Lights, SpotsFadeAndHaveTheirSpectrum) {
    LightDescription spot = of_kind(LightKind::spot, {0.0, 0.0, 5.0}, 0.5);
    spot.cone_deg = 60.0;
    spot.blend = 0.5;
    spot.illuminant = IlluminantKind::a;
    spot.radiance = 3.0;
    const LightData data({spot}, Upsampling::basis, 0.0f);
    const LightView& light = data.view().lights[0];
    const auto towards = [](double angle_deg) {
        const double angle = units::rad_from_deg(angle_deg);
        return Vec3{float(std::sin(angle)), 0.0f, -float(std::cos(angle))};
    };
    EXPECT_FLOAT_EQ(light_falloff(light, towards(14.9)), 1.0f);
    EXPECT_EQ(light_falloff(light, towards(30.1)), 0.0f);
    EXPECT_GT(light_falloff(light, towards(20.0)), light_falloff(light, towards(25.0)));
    const SampledSpectrum a = illuminant_spectrum(IlluminantKind::a);
    for (const double wavelength_nm : {420.0, 555.5, 700.0})
        EXPECT_NEAR(double(light_radiance(light, -towards(0.0), float(wavelength_nm))), 3.0 * a.at(wavelength_nm), 2.0e-3);
    EXPECT_NEAR(double(light.luminance), 3.0, 1.0e-3);
}

}  // namespace
}  // namespace opal
