// SPDX-License-Identifier: GPL-3.0-or-later
#include "media_checks_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "formats/atomic_file.h"
#include "formats/colorimetry.h"
#include "formats/error.h"
#include "formats/illuminant.h"
#include "formats/image.h"
#include "formats/units.h"
#include "renderer/cpu/render_picture.h"

namespace opal {
namespace {

/// The scenes' ball, seen by their camera.
constexpr double radius_mm = 5.0, distance_mm = 40.0;

struct Row {
    double samples_per_second, mean, error, variance;
};

/// A disc of 15 degrees radius, 45 degrees up, 600 times as bright as the rest.
void write_disc(const std::filesystem::path& file) {
    Image image;
    image.width = 512;
    image.height = 256;
    image.channel_names = {"R", "G", "B"};
    const double up = units::pi / 4.0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double elevation = units::pi * (0.5 - (y + 0.5) / image.height);
            const double azimuth = 2.0 * units::pi * ((x + 0.5) / image.width - 0.375);
            const double cosine = std::sin(elevation) * std::sin(up) + std::cos(elevation) * std::cos(up) * std::cos(azimuth);
            image.pixels.insert(image.pixels.end(), 3, cosine > std::cos(units::rad_from_deg(15.0)) ? 30.0f : 0.05f);
        }
    write_exr(file, image);
}

/// Pixels whose four corners lie inside the ball's outline.
std::vector<std::uint32_t> gem_pixels(const SceneDescription& scene) {
    const int width = scene.render.width, height = scene.render.height;
    const double outline = std::tan(std::asin(radius_mm / distance_mm)) * 0.5 * height /
                           std::tan(0.5 * units::rad_from_deg(scene.camera.vertical_fov_deg));
    std::vector<std::uint32_t> pixels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double far_x = std::abs(x + 0.5 - 0.5 * width) + 0.5, far_y = std::abs(y + 0.5 - 0.5 * height) + 0.5;
            if (std::hypot(far_x, far_y) < outline) pixels.push_back(std::uint32_t(y * width + x));
        }
    return pixels;
}

Image rendered(SceneDescription scene, std::uint64_t seed, int samples, double& seconds) {
    scene.render.seed = seed;
    std::vector<std::string> notices;
    const HostScene host(scene, notices);
    const EmbreeScene intersector(host.meshes());
    Film film(scene.render.width, scene.render.height, false, xyz_of(illuminant_spectrum(scene.film.white)));
    seconds += render_picture(host, intersector, {samples, 0.0, 0.0}, film, [](const RenderProgress&) {}).seconds;
    return film.to_image();
}

Row measure(const SceneDescription& scene, int samples) {
    double seconds = 0.0;
    const Image first = rendered(scene, 1, samples, seconds), second = rendered(scene, 2, samples, seconds);
    const std::vector<std::uint32_t> gem = gem_pixels(scene);
    const auto luminance = [](const Image& image, std::uint32_t pixel) {
        const float* rgb = image.pixel(int(pixel) % image.width, int(pixel) / image.width);
        return xyz_from_linear_srgb({double(rgb[0]), double(rgb[1]), double(rgb[2])}).y;
    };
    double sum = 0.0, squares = 0.0;
    for (const std::uint32_t pixel : gem) {
        const double a = luminance(first, pixel), b = luminance(second, pixel);
        sum += 0.5 * (a + b);
        squares += 0.5 * (a - b) * (a - b);
    }
    const double n = double(gem.size());
    const double of_pixel = squares / n;
    return {2.0 * samples * scene.render.width * scene.render.height / seconds, sum / n, std::sqrt(0.5 * of_pixel / n),
            of_pixel * samples};
}

}  // namespace

void bench_media_checks(const std::filesystem::path& scenes, const std::filesystem::path& folder, int samples) {
    std::filesystem::create_directories(folder);
    const std::filesystem::path disc = folder / "disc.exr";
    write_disc(disc);
    AtomicFile file(folder / "media_checks.csv");
    std::ofstream csv(file.temporary_path());
    csv << "scene,light,sampler,samples_per_second,gem_mean,standard_error,variance_of_one_sample,variance_times_us\n";
    for (const char* light : {"uniform", "disc"})
        for (const char* name : {"glass", "milk", "cloudy"})
            for (const char* sampler : {"independent", "stratified"}) {
                std::vector<std::string> overrides = {fmt::format("render.sampler=\"{}\"", sampler)};
                if (std::string(light) == "disc") {
                    overrides.push_back("environment.kind=\"file\"");
                    overrides.push_back(fmt::format("environment.file='{}'", std::filesystem::absolute(disc).string()));
                }
                const Row row = measure(read_scene(scenes / (std::string(name) + ".toml"), overrides), samples);
                const double product = row.variance / row.samples_per_second * 1.0e6;
                fmt::print("{:<7} {:<6} {:<11} {:>9.0f} samples/s  mean {:.5f} +- {:.5f}  variance {:.3e}  x time {:.3e} us\n",
                           light, name, sampler, row.samples_per_second, row.mean, row.error, row.variance, product);
                std::fflush(stdout);
                csv << fmt::format("{},{},{},{:.6g},{:.6f},{:.6f},{:.4g},{:.4g}\n", name, light, sampler, row.samples_per_second,
                                   row.mean, row.error, row.variance, product);
            }
    csv.close();
    if (!csv) throw SystemError(fmt::format("{}: writing failed", (folder / "media_checks.csv").string()));
    file.commit();
}

}  // namespace opal
