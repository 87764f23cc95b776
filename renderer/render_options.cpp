// SPDX-License-Identifier: Apache-2.0
#include "renderer/render_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "formats/error.h"
#include "renderer/render_command.h"

namespace opal {
namespace {

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

}  // namespace

std::filesystem::path RenderOptions::png() const {
    std::filesystem::path path = output;
    return path.replace_extension(".png");
}

std::string RenderOptions::command() const {
    std::string text = "opal-render " + scene_file.string();
    for (const std::string& assignment : overrides) text += " --set " + assignment;
    if (samples > 0) text += fmt::format(" --spp {}", samples);
    if (!time.empty()) text += " --time " + time;
    if (seed) text += fmt::format(" --seed {}", *seed);
    return text;
}

std::optional<int> parse_render_options(int argc, char** argv, RenderOptions& options) {
    CLI::App app("opal-render: renders a scene that holds an opal, with a spectral path tracer");
    app.footer(footer);
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
    if (const std::optional<int> code = parse_command_line(app, argc, argv)) return code;
    options.time_limit_s = parse_duration(options.time);
    if (options.device == "cuda") throw InputError("--device cuda: this build has no CUDA backend; allowed: auto, cpu");
    if (options.output.extension() != ".exr")
        throw InputError(fmt::format("output {}: the name must end in .exr", options.output.string()));
    if (options.stats_file == options.output) throw InputError("--stats: names the same file as the picture");
    return std::nullopt;
}

SceneDescription read_scene(const RenderOptions& options) {
    SceneDescription scene = read_scene(options.scene_file, options.overrides);
    if (options.samples > 0) scene.render.samples = options.samples;
    if (options.seed) scene.render.seed = std::uint64_t(*options.seed);
    return scene;
}

}  // namespace opal
