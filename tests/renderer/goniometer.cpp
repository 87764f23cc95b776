// SPDX-License-Identifier: Apache-2.0
#include "goniometer.h"

#include <cmath>

#include "formats/image.h"
#include "formats/scene.h"
#include "formats/units.h"
#include "renderer/core/path_tracer.h"

namespace opal {
namespace {

class Mean {
  public:
    void add(double value) {
        sum_ += value;
        square_ += value * value;
        ++count_;
    }
    Goniometer::Reading reading(double scale) const {
        const double mean = sum_ / count_;
        return {scale * mean, scale * std::sqrt(std::max(0.0, square_ / count_ - mean * mean) / (count_ - 1))};
    }

  private:
    double sum_ = 0.0, square_ = 0.0;
    int count_ = 0;
};

/// A ray along `direction` from outside the sample, towards a disc across it.
Ray towards_disc(Vec3 direction, double disc_radius_mm, double distance_mm, float u, float v) {
    const float radius_mm = float(disc_radius_mm) * std::sqrt(u), angle_rad = 2.0f * pi_f * v;
    const Vec3 across =
        Frame(direction).world_from_local({radius_mm * std::cos(angle_rad), radius_mm * std::sin(angle_rad), 0.0f});
    return {across - float(distance_mm) * direction, direction};
}

}  // namespace

Goniometer::Goniometer(const std::string& scene_toml, double radius_mm, bool as_devices_do)
    : radius_mm_(radius_mm),
      scene_(parse_scene(scene_toml, "goniometer.toml", {}), notices_),
      intersector_(scene_.meshes()),
      view_(scene_.view()) {
    if (!as_devices_do) return;
    bvh_.emplace(scene_.meshes());
    view_ = copied_scene(scene_.view(), arrays_);
}

double Goniometer::trace(const Ray& ray, double wavelength_nm, std::uint32_t path, std::uint64_t seed) const {
    PathWavelengths<1> wavelengths{{float(wavelength_nm)}, {1.0f}, 1};
    PathRandom random(seed, 0, path);
    PathCounters counters;
    const float white = table_at(view_.spectra.white, float(wavelength_nm));
    if (bvh_) {
        const BvhView<true> rays = bvh_->view<true>(view_.meshes);
        PathTracer<1, BvhView<true>> tracer(view_, rays, wavelengths, random, counters);
        return double(tracer.trace(ray).radiance.v[0] / white);
    }
    PathTracer<1, EmbreeScene> tracer(view_, intersector_, wavelengths, random, counters);
    return double(tracer.trace(ray).radiance.v[0] / white);
}

Goniometer::Reading Goniometer::radiance(Vec3 direction, double spot_radius_mm, double wavelength_nm, int paths,
                                         std::uint64_t seed) const {
    Mean mean;
    for (int path = 0; path < paths; ++path) {
        const RandomBlock block = random_block(seed, RandomStream::bench, std::uint64_t(path), 0);
        const Ray ray = towards_disc(direction, spot_radius_mm, 2.0 * radius_mm_, uniform_float(block.value[0]),
                                     uniform_float(block.value[1]));
        mean.add(trace(ray, wavelength_nm, std::uint32_t(path), seed));
    }
    return mean.reading(1.0);
}

Goniometer::Reading Goniometer::exchange(const EnvironmentMap& detector, double wavelength_nm, int paths,
                                         std::uint64_t seed) const {
    const EnvironmentView view = detector.view();
    Mean mean;
    for (int path = 0; path < paths; ++path) {
        const RandomBlock block = random_block(seed, RandomStream::bench, std::uint64_t(path), 0);
        const Vec3 towards = sample_environment(view, uniform_float(block.value[0]), uniform_float(block.value[1]));
        const float pdf = environment_pdf(view, towards);
        const float color = environment_color(scene_.view().spectra, environment_footprint(view, towards), float(wavelength_nm));
        const double sensitivity = pdf > 0.0f ? double(color / pdf) : 0.0;
        const Ray ray =
            towards_disc(-towards, radius_mm_, 2.0 * radius_mm_, uniform_float(block.value[2]), uniform_float(block.value[3]));
        mean.add(sensitivity * trace(ray, wavelength_nm, std::uint32_t(path), seed));
    }
    return mean.reading(units::pi * radius_mm_ * radius_mm_);
}

void write_cap(const std::filesystem::path& path, Vec3 direction, double angle_deg) {
    Image image;
    image.width = 360;
    image.height = 180;
    image.channel_names = {"R", "G", "B"};
    image.pixels.assign(std::size_t(image.width) * image.height * 3, 0.0f);
    const double limit = std::cos(units::rad_from_deg(angle_deg));
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double theta = units::pi * (y + 0.5) / image.height, phi = 2.0 * units::pi * (x + 0.5) / image.width;
            const Vec3 towards{float(std::sin(theta) * std::cos(phi)), float(std::sin(theta) * std::sin(phi)),
                               float(std::cos(theta))};
            if (double(dot(towards, direction)) < limit) continue;
            // Longitude runs the other way in files.
            const int column = ((image.width - 1 - x) + 3 * image.width / 4) % image.width;
            std::fill_n(image.pixel(column, y), 3, 1.0f);
        }
    write_exr(path, image);
}

EnvironmentMap read_environment(const std::filesystem::path& path) {
    EnvironmentDescription description;
    description.kind = EnvironmentKind::file;
    description.file = path;
    return make_environment(description);
}

}  // namespace opal
