// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "formats/random.h"
#include "formats/units.h"
#include "on_backends.h"
#include "renderer/host/host_scene.h"
#include "small_opal.h"

namespace opal {
namespace {

class RenderedBall : public OnBackends {};

constexpr int size_px = 64;

double square(double x) {
    return x * x;
}

/// Second and fourth moments of a blur about the picture's middle, in pixels.
struct Moments {
    double second = 0.0;           ///< mean of (x^2 + y^2) / 2
    double second_variance = 0.0;  ///< of a single value
    double fourth = 0.0;           ///< mean of (x^2 + y^2)^2
    double hits = 0.0;
};

/// Where in the picture a bright disc, centred on the axis at `depth_mm`, is seen.
Moments blur_of_disc(const Camera& camera, float depth_mm, float disc_radius_mm) {
    Moments moments;
    for (std::uint64_t i = 0; i < 2'000'000; ++i) {
        const RandomBlock block = random_block(7, RandomStream::bench, i, 0);
        const float x = uniform_float(block.value[0]), y = uniform_float(block.value[1]);
        const Ray ray = camera_ray(camera, x, y, uniform_float(block.value[2]), uniform_float(block.value[3]));
        const float distance_mm =
            (depth_mm - dot(ray.origin - camera.position, camera.forward)) / dot(ray.direction, camera.forward);
        const Vec3 place = ray.origin + distance_mm * ray.direction - (camera.position + depth_mm * camera.forward);
        if (length(place) > disc_radius_mm) continue;
        const double px = size_px * (double(x) - 0.5), py = size_px * (double(y) - 0.5), r2 = px * px + py * py;
        moments.hits += 1.0;
        moments.second += 0.5 * r2;
        moments.second_variance += 0.25 * r2 * r2;
        moments.fourth += r2 * r2;
    }
    moments.second /= moments.hits;
    moments.fourth /= moments.hits;
    moments.second_variance = moments.second_variance / moments.hits - moments.second * moments.second;
    return moments;
}

CameraDescription lens(CameraKind kind) {
    CameraDescription description;
    description.kind = kind;
    description.position_mm = {3.0, -90.0, 7.0};
    description.target_mm = {3.0, 10.0, 7.0};
    description.vertical_fov_deg = 3.0;
    description.view_height_mm = 5.0;
    description.aperture_radius_mm = 1.5;
    description.focus_mm = 80.0;
    return description;
}

/// The blur of a point at depth z is a uniform disc: rays of one picture position cross the lens of radius A and meet again at
/// the focal distance f, so that at z they fill a disc of radius A |z - f| / f. A disc of radius r seen through it has the mean
/// squares of both added, a quarter of each radius squared per axis.
void expect_closed_form(const CameraDescription& description, double px_per_mm_at_depth, double depth_mm) {
    constexpr double disc_radius_mm = 0.25;
    const double blur_mm = description.aperture_radius_mm * std::abs(depth_mm - description.focus_mm) / description.focus_mm;
    const Moments moments = blur_of_disc(make_camera(description, size_px, size_px), float(depth_mm), float(disc_radius_mm));
    const double expected = 0.25 * square(px_per_mm_at_depth) * (blur_mm * blur_mm + disc_radius_mm * disc_radius_mm);
    const double error = std::sqrt(moments.second_variance / moments.hits);
    EXPECT_NEAR(moments.second, expected, 4.0 * error) << depth_mm;
    EXPECT_LT(error, 0.02 * expected);
}

TEST(Camera, CircleOfConfusionOfAPerspectiveLens) {
    const CameraDescription description = lens(CameraKind::perspective);
    const double unit_height = 2.0 * std::tan(0.5 * units::rad_from_deg(description.vertical_fov_deg));
    for (const double depth_mm : {60.0, 80.0, 110.0})
        expect_closed_form(description, size_px / (unit_height * depth_mm), depth_mm);
}

TEST(Camera, CircleOfConfusionOfAnOrthographicLens) {
    const CameraDescription description = lens(CameraKind::orthographic);
    for (const double depth_mm : {50.0, 80.0, 130.0})
        expect_closed_form(description, size_px / description.view_height_mm, depth_mm);
}

/// A small white ball before black: how far its light is spread over the picture, about its middle, in px^2 per axis, and the
/// standard error that the pixels' variances give.
MeanEstimate spread_of_ball(const char* backend, const std::string& camera) {
    const Rendered rendered = render_text(
        "[render]\nwidth = 48\nheight = 48\nfilter = \"box\"\n[environment]\nkind = \"constant\"\n"
        "[camera]\nposition_mm = [0, -100, 0]\ntarget_mm = [0, 0, 0]\n" +
            camera +
            "[[material]]\nname = \"white\"\nalbedo = 0.9\n[[material]]\nname = \"black\"\nalbedo = 0.0\n"
            "[[object]]\nkind = \"sphere\"\nmaterial = \"white\"\nradius_mm = 0.2\n"
            "[[object]]\nkind = \"plane\"\nmaterial = \"black\"\ntranslate_mm = [0, 20, 0]\nrotate_deg = [90, 0, 0]\n",
        64, backend);
    const Image& image = rendered.image;
    const int mean = image.find_channel("G"), variance = image.find_channel("variance.G");
    double sum = 0.0, second = 0.0;
    const auto r2 = [](int x, int y) { return 0.5 * (square(x - 23.5) + square(y - 23.5)); };
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x) {
            sum += double(image.pixel(x, y)[mean]);
            second += r2(x, y) * double(image.pixel(x, y)[mean]);
        }
    double error = 0.0;
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x) error += square((r2(x, y) - second / sum) / sum) * double(image.pixel(x, y)[variance]);
    return {second / sum, std::sqrt(error)};
}

/// What an open lens adds to the spread is a quarter of the squared radius of the circle of confusion.
TEST_P(RenderedBall, IsBlurredByTheCircleOfConfusion) {
    const double unit_height = 2.0 * std::tan(0.5 * units::rad_from_deg(2.5));
    const MeanEstimate sharp = spread_of_ball(GetParam(), "vertical_fov_deg = 2.5\n");
    const MeanEstimate blurred = spread_of_ball(GetParam(), "vertical_fov_deg = 2.5\naperture_radius_mm = 2\nfocus_mm = 80\n");
    const double radius_px = 2.0 * 20.0 / (100.0 * 80.0) / unit_height * 48.0;
    EXPECT_NEAR(blurred.mean - sharp.mean, 0.25 * radius_px * radius_px,
                4.0 * std::hypot(sharp.standard_error, blurred.standard_error));
    EXPECT_LT(blurred.standard_error, 0.05 * blurred.mean);
}

/// Pixels whose centres see the first object.
int pixels_of_first_object(const std::string& settings) {
    const Rendered rendered =
        render_text(settings +
                        "[film]\naovs = [\"object_id\"]\n[[material]]\nname = \"m\"\n[[object]]\nkind = \"sphere\"\n"
                        "material = \"m\"\nradius_mm = 3\n",
                    1);
    const int channel = rendered.image.find_channel("object_id");
    int count = 0;
    for (int y = 0; y < rendered.image.height; ++y)
        for (int x = 0; x < rendered.image.width; ++x) count += rendered.image.pixel(x, y)[channel] == 0.0f ? 1 : 0;
    return count;
}

/// A ball of radius r covers pi (r / height * pixels)^2 pixels whatever its distance; the number of centres in a circle of that
/// size differs from its area by a few. The ball is a mesh inside the sphere: 0.3 % less.
TEST(Camera, OrthographicScale) {
    const std::string size = "[render]\nwidth = 200\nheight = 100\n[camera]\nkind = \"orthographic\"\nview_height_mm = 8\n";
    const double expected = units::pi * square(3.0 / 8.0 * 100.0);
    EXPECT_NEAR(pixels_of_first_object(size + "position_mm = [0, -20, 0]\ntarget_mm = [0, 0, 0]\n"), expected, 0.01 * expected);
    EXPECT_NEAR(pixels_of_first_object(size + "position_mm = [30, -500, 400]\ntarget_mm = [0, 0, 0]\n"), expected,
                0.01 * expected);
}

/// A ball of radius r at distance d is seen under the half angle asin(r / d).
TEST(Camera, PerspectiveScale) {
    const double half_px = std::tan(std::asin(3.0 / 25.0)) / std::tan(0.5 * units::rad_from_deg(20.0)) * 50.0;
    const double expected = units::pi * half_px * half_px;
    EXPECT_NEAR(pixels_of_first_object("[render]\nwidth = 150\nheight = 100\n[camera]\nvertical_fov_deg = 20\n"
                                       "position_mm = [0, -15, 20]\ntarget_mm = [0, 0, 0]\n"),
                expected, 0.01 * expected);
}

INSTANTIATE_TEST_SUITE_P(, RenderedBall, cpu_loop_and_cuda(), backend_name);

}  // namespace
}  // namespace opal
