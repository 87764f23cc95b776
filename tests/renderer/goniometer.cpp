// SPDX-License-Identifier: Apache-2.0
#include "goniometer.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <numeric>

#include "backends.h"
#include "formats/image.h"
#include "formats/scene.h"
#include "formats/units.h"
#include "renderer/core/path_tracer.h"
#include "renderer/host/film.h"

namespace opal {
namespace {

/// Edge of the detector's pictures, pixels.
constexpr int picture_edge = 16;
constexpr int picture_pixels = picture_edge * picture_edge;

int samples_for(int paths) {
    return std::max(1, (paths + picture_pixels - 1) / picture_pixels);
}

/// The spectrum's tables for paths of one wavelength: inverting this integrated density gives it for every number in [0, 1), to
/// a hundred-thousandth of a nanometre and the rounding of a float.
class OneWavelength {
  public:
    explicit OneWavelength(double wavelength_nm) : pdf_(spectrum_samples, 1.0f), cdf_(spectrum_samples) {
        constexpr double steepness_per_nm = 1.0e5;
        for (int i = 0; i < spectrum_samples; ++i)
            cdf_[std::size_t(i)] = float((double(spectrum_min_nm) + i - wavelength_nm) * steepness_per_nm);
    }
    void confine(SpectrumTables& tables) const {
        tables.pdf = pdf_.data();
        tables.cdf = cdf_.data();
        tables.alias = {};
    }

  private:
    std::vector<float> pdf_, cdf_;
};

/// Looks along `direction` at a square of the plane across it through the origin, from `distance_mm` before it.
Camera detector_camera(Vec3 direction, double edge_mm, double distance_mm) {
    const Frame across(direction);
    Camera camera;
    camera.position = -float(distance_mm) * direction;
    camera.forward = direction;
    camera.right = float(edge_mm) * across.tangent;
    camera.down = float(edge_mm) * across.bitangent;
    camera.orthographic = true;
    return camera;
}

/// Draws on the processor as the renderer does there.
void draw_with_embree(const SceneView& view, const EmbreeScene& intersector, Film& film, int samples) {
    tbb::parallel_for(0, film.num_blocks(), [&](int b) {
        FilmBlock& block = film.block(b);
        const PixelWindow window = film.block_window(b);
        for (int sample = 0; sample < samples; ++sample)
            for (int y = window.y0; y < window.y1; ++y)
                for (int x = window.x0; x < window.x1; ++x) {
                    const std::uint32_t pixel = std::uint32_t(y * film.width() + x);
                    PathWavelengths<1> wavelengths;
                    const PathResult<1> result =
                        trace_sample(view, intersector, pixel, std::uint32_t(sample), wavelengths, block.counters);
                    film.add(view.spectra, pixel, film_sample(wavelengths, result), block.totals);
                }
    });
}

/// Mean radiance of a film's samples, which all are of one wavelength.
Goniometer::Reading mean_radiance(const Film& film) {
    SpectrumTotals totals;
    for (int b = 0; b < film.num_blocks(); ++b) totals.add(film.block(b).totals);
    double sum = 0.0, square = 0.0;
    for (int bin = 0; bin < num_bins; ++bin) {
        sum += totals.radiance[std::size_t(bin)] * bin_width_nm(bin);
        square += totals.radiance_squared[std::size_t(bin)] * bin_width_nm(bin) * bin_width_nm(bin);
    }
    const double n = double(film.total_samples()), mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, square / n - mean * mean) / (n - 1.0))};
}

}  // namespace

Goniometer::Goniometer(const std::string& scene_toml, double radius_mm, std::string backend)
    : radius_mm_(radius_mm),
      backend_(std::move(backend)),
      scene_(parse_scene(scene_toml, "goniometer.toml",
                         {"render.sampler=independent", "render.filter=box", "opal.companions=0",
                          fmt::format("render.width={}", picture_edge), fmt::format("render.height={}", picture_edge)}),
             notices_),
      intersector_(scene_.meshes()) {}

Goniometer::Reading Goniometer::radiance(Vec3 direction, double half_edge_mm, double wavelength_nm, int paths,
                                         std::uint64_t seed) const {
    const OneWavelength line(wavelength_nm);
    SceneView view = scene_.view();
    view.seed = seed;
    view.camera = detector_camera(direction, 2.0 * half_edge_mm, 2.0 * radius_mm_);
    line.confine(view.spectra);
    Film film(picture_edge, picture_edge, false);
    if (const MakeDevice make_device = backend_maker(backend_, scene_.meshes())) {
        std::vector<int> blocks(std::size_t(film.num_blocks()));
        std::iota(blocks.begin(), blocks.end(), 0);
        make_device(view, film)->advance(film, blocks, std::uint32_t(samples_for(paths)));
    } else {
        draw_with_embree(view, intersector_, film, samples_for(paths));
    }
    const Reading found = mean_radiance(film);
    const double white = double(table_at(view.spectra.white, float(wavelength_nm)));
    return {found.mean / white, found.standard_error / white};
}

Goniometer::Reading Goniometer::exchange(const EnvironmentMap& detector, double wavelength_nm, int paths,
                                         std::uint64_t seed) const {
    // One direction from each of as many strata; neighbours in pairs tell, if anything too pessimistically, how much it scatters.
    constexpr int strata = 32, num_directions = strata * strata;
    const EnvironmentView view = detector.view();
    double sum = 0.0, squared_error = 0.0, first_of_pair = 0.0;
    for (int i = 0; i < num_directions; ++i) {
        const RandomBlock block = random_block(seed, RandomStream::bench, std::uint64_t(i), 0);
        const auto within = [](int stratum, std::uint32_t bits) {
            return std::min((float(stratum) + uniform_float(bits)) / strata, 0x1.fffffep-1f);
        };
        const Vec3 towards = sample_environment(view, within(i / strata, block.value[0]), within(i % strata, block.value[1]));
        const float pdf = environment_pdf(view, towards);
        double flux = 0.0;
        if (pdf > 0.0f) {
            const float color =
                environment_color(scene_.view().spectra, environment_footprint(view, towards), float(wavelength_nm));
            const Reading seen = radiance(-towards, radius_mm_, wavelength_nm, paths / num_directions,
                                          seed + std::uint64_t(num_directions) * std::uint64_t(1 + i));
            flux = 4.0 * radius_mm_ * radius_mm_ * double(color / pdf) * seen.mean / num_directions;
        }
        sum += flux;
        if (i % 2 == 1) squared_error += (flux - first_of_pair) * (flux - first_of_pair);
        first_of_pair = flux;
    }
    return {sum, std::sqrt(squared_error)};
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
