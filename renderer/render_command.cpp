// SPDX-License-Identifier: Apache-2.0
#include "renderer/render_command.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <optional>

#include "formats/atomic_file.h"
#include "formats/command.h"
#include "formats/error.h"
#include "formats/illuminant.h"
#include "formats/report.h"
#include "formats/scene.h"
#include "formats_generated/version.h"
#include "renderer/cpu/render_cpu.h"
#include "renderer/host/tone_mapping.h"

namespace opal {
namespace {

struct RenderOptions {
    std::filesystem::path scene_file, output, stats_file;
    std::vector<std::string> overrides;
    int samples = 0;
    std::string time;
    int threads = 0;
    std::optional<std::int64_t> seed;
    std::string device = "auto";
    /// The command as it decides the picture: without the output's name, threads and statistics, so that the same picture has the
    /// same bytes.
    std::string command() const {
        std::string text = "opal-render " + scene_file.string();
        for (const std::string& assignment : overrides) text += " --set " + assignment;
        if (samples > 0) text += fmt::format(" --spp {}", samples);
        if (!time.empty()) text += " --time " + time;
        if (seed) text += fmt::format(" --seed {}", *seed);
        return text;
    }
};

constexpr const char* footer = R"(Lengths are mm, wavelengths vacuum nm, angles degrees.

Writes OUT.exr (linear sRGB: R, G, B, the variance of each mean, samples per pixel; the resolved scene and the recipe in
the header) and OUT.png beside it, tone-mapped. Ctrl-C writes what is there.

Examples:
  opal-render examples/precious_opal/scene.toml -o out/precious_opal.exr
  opal-render scene.toml -o draft.exr --spp 16 --set render.width=480 --set render.height=360
  opal-render scene.toml -o lit_from_the_right.exr --set environment.rotate_deg=60 --time 60s)";

/// "60", "60s", "5m", "2h" -> seconds.
double parse_duration(const std::string& text) {
    if (text.empty()) return 0.0;
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const std::string unit = end;
    const double scale = unit.empty() || unit == "s" ? 1.0 : (unit == "m" ? 60.0 : (unit == "h" ? 3600.0 : 0.0));
    if (!(value > 0.0) || !std::isfinite(value) || scale == 0.0)
        throw InputError(fmt::format("--time {}: expected a positive number of seconds, or with a unit: 90s, 5m, 2h", text));
    return value * scale;
}

/// Returns an exit code where the command line alone decides (help, version).
std::optional<int> parse_options(int argc, char** argv, RenderOptions& options) {
    CLI::App app("opal-render: renders a scene that holds an opal, with a spectral path tracer");
    app.footer(footer);
    app.set_version_flag("--version", std::string("opal-render ") + OPAL_VERSION_STRING);
    app.add_option("SCENE", options.scene_file, "scene.toml")->required();
    app.add_option("-o,--output", options.output, "picture to write (.exr); a .png appears beside it")->required();
    app.add_option("--set", options.overrides, "override a key of the scene: key.path=value (TOML); repeatable")
        ->take_all()
        ->allow_extra_args(false);
    app.add_option("--spp", options.samples, "samples per pixel, instead of render.samples")->check(CLI::Range(1, 1 << 24));
    app.add_option("--time", options.time, "stop after this long: seconds, or 90s, 5m, 2h");
    app.add_option("--threads", options.threads, "worker threads (default: all cores)")->check(CLI::Range(1, 4096));
    app.add_option("--seed", options.seed, "random seed, instead of render.seed")->check(CLI::Range(std::int64_t(0), INT64_MAX));
    app.add_option("--device", options.device, "auto, cpu or cuda (this build: cpu)")
        ->check(CLI::IsMember({"auto", "cpu", "cuda"}));
    app.add_option("--stats", options.stats_file, "write statistics as JSON");
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {
        return app.exit(success);
    } catch (const CLI::ParseError& error) {
        throw InputError(fmt::format("{} (opal-render --help shows the options)", error.what()));
    }
    if (options.device == "cuda") throw InputError("--device cuda: this build has no CUDA backend; allowed: auto, cpu");
    if (options.output.extension() != ".exr")
        throw InputError(fmt::format("output {}: the name must end in .exr", options.output.string()));
    if (options.stats_file == options.output) throw InputError("--stats: names the same file as the picture");
    return std::nullopt;
}

nlohmann::json spectrum_report(const SpectrumTotals& totals, const SpectrumTables& tables) {
    nlohmann::json bins = nlohmann::json::array();
    const double n = std::max<double>(1.0, double(totals.samples));
    for (int bin = 0; bin < num_bins; ++bin) {
        // Mean of the white over the bin, so that a white furnace reports 1.
        double white = 0.0;
        int count = 0;
        for (double wavelength = std::max(360.0, bin_centre_nm(bin) - 5.0);
             wavelength <= std::min(830.0, bin_centre_nm(bin) + 5.0); wavelength += 0.25, ++count)
            white += double(table_at(tables.white, float(wavelength)));
        white /= count;
        const double mean = totals.radiance[bin] / n;
        const double variance = std::max(0.0, totals.radiance_squared[bin] / n - mean * mean) / std::max(1.0, n - 1.0);
        bins.push_back({{"wavelength_nm", bin_centre_nm(bin)},
                        {"radiance_over_white", mean / white},
                        {"standard_error", std::sqrt(variance) / white},
                        {"truncated", totals.truncated[bin] / n}});
    }
    return bins;
}

nlohmann::json make_report(const SceneDescription& scene, const HostScene& host, const RenderOutcome& outcome, const Film& film,
                           double loading_s, int threads) {
    const PathCounters& counters = outcome.counters;
    const std::uint64_t samples = film.total_samples();
    const GrainSource* grains = host.grains();
    return {
        {"seconds", {{"loading", loading_s}, {"rendering", outcome.seconds}}},
        {"peak_memory_bytes", peak_memory_bytes()},
        {"threads", threads},
        {"seed", scene.render.seed},
        {"interrupted", outcome.interrupted},
        {"counts",
         {{"samples", samples},
          {"samples_per_pixel", outcome.finished_samples},
          {"grains", host.num_grains()},
          {"reciprocal_points", host.reciprocal_points()},
          {"grain_crossings", counters.grain_crossings},
          {"diffractions_back", counters.turns_back},
          {"multi_beam_stays", counters.multi_beam_stays},
          {"diffractions", counters.diffractions},
          {"scatterings", counters.scatterings},
          {"truncated_paths", counters.truncated_paths},
          {"lost_paths", counters.lost_paths},
          {"not_a_number", counters.not_a_number},
          {"majorant_violations", counters.majorant_violations}}},
        {"grains", {{"method", grains ? grains->method_name() : "none"}, {"memory_bytes", grains ? grains->size_bytes() : 0}}},
        {"paths_per_second", double(samples) / std::max(1.0e-9, outcome.seconds)},
        {"truncated_rgb",
         {outcome.totals.truncated_rgb[0] / double(samples), outcome.totals.truncated_rgb[1] / double(samples),
          outcome.totals.truncated_rgb[2] / double(samples)}},
        {"spectrum", spectrum_report(outcome.totals, host.view().spectra)},
        {"versions", version_report()},
        {"scene", scene_to_toml(scene)}};
}

}  // namespace

int render_command(int argc, char** argv) {
    RenderOptions options;
    if (const std::optional<int> code = parse_options(argc, argv, options)) return *code;
    const double time_limit_s = parse_duration(options.time);
    SceneDescription scene = read_scene(options.scene_file, options.overrides);
    if (options.samples > 0) scene.render.samples = options.samples;
    if (options.seed) scene.render.seed = std::uint64_t(*options.seed);
    std::filesystem::path png = options.output;
    png.replace_extension(".png");
    require_writable(options.output);
    require_writable(png);
    if (!options.stats_file.empty()) require_writable(options.stats_file);

    std::optional<tbb::global_control> limit;
    if (options.threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(options.threads));
    const int threads = int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));

    const Stopwatch loading;
    std::vector<std::string> notices;
    const HostScene host(scene, notices);
    const EmbreeScene intersector(host.meshes());
    for (const std::string& notice : notices) fmt::print(stderr, "opal-render: note: {}\n", notice);
    const double loading_s = loading.seconds();

    catch_interrupts();
    const Xyz white = xyz_of(illuminant_spectrum(scene.film.white));
    Film film(scene.render.width, scene.render.height, scene.film.spectral, white);
    RenderOutcome outcome;
    {
        Progress progress("rendering");
        outcome =
            render_cpu(host, intersector, {scene.render.samples, time_limit_s}, film, [&](double f) { progress.update(f); });
    }
    if (film.total_samples() == 0) throw Interrupted();

    Image image = film.to_image();
    add_aovs(host, intersector, scene.film.aovs, image);
    image.attributes = {
        {"opal:command", options.command()},
        {"opal:scene", scene_to_toml(scene)},
        {"opal:recipe", host.recipe_toml()},
        {"opal:white", fmt::format("xy {:.5f} {:.5f} is neutral: RGB is adapted from it to D65 by Bradford's matrix",
                                   chromaticity_of(white).x, chromaticity_of(white).y)},
        {"opal:version", OPAL_VERSION_STRING},
        {"Software", std::string("opal-render ") + OPAL_VERSION_STRING}};
    write_exr(options.output, image);
    write_png(png, tone_mapped(image, scene.film.exposure_ev));
    if (!options.stats_file.empty())
        write_report(options.stats_file, make_report(scene, host, outcome, film, loading_s, threads));

    const PathCounters& counters = outcome.counters;
    fmt::print("{}{} and {}: {}x{}, {} samples per pixel, {} ({:.0f} paths/s); truncated paths {}, lost {}, NaN {}\n",
               outcome.interrupted ? "interrupted; wrote what is there: " : "", options.output.string(), png.filename().string(),
               scene.render.width, scene.render.height, outcome.finished_samples, format_duration(outcome.seconds),
               double(film.total_samples()) / std::max(1.0e-9, outcome.seconds), counters.truncated_paths, counters.lost_paths,
               counters.not_a_number);
    // From here on the missing light shows: the body of a milky opal turns dark and reddish.
    if (double(counters.truncated_paths) > 0.01 * double(film.total_samples()))
        fmt::print(stderr,
                   "opal-render: warning: {:.1f} % of the paths were cut off after {} bounces; raise render.max_bounces\n",
                   100.0 * double(counters.truncated_paths) / double(film.total_samples()), scene.render.max_bounces);
    if (counters.majorant_violations > 0)
        fmt::print(stderr, "opal-render: warning: {} collisions met a field above its majorant; please report the scene\n",
                   counters.majorant_violations);
    if (counters.not_a_number > 0)
        fmt::print(stderr, "opal-render: warning: {} samples were not numbers and count as black; please report the scene\n",
                   counters.not_a_number);
    return 0;
}

}  // namespace opal
