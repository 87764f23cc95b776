// SPDX-License-Identifier: Apache-2.0
#include "renderer/render_options.h"
#include "formats/number_option.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "formats/error.h"
#include "formats/quality.h"
#include "renderer/pixel_window_flag.h"
#include "renderer/render_command.h"

namespace opal {
namespace {

constexpr const char* footer = R"(Lengths are mm, wavelengths vacuum nm, angles degrees.

Writes OUT.exr (linear sRGB: R, G, B, the variance of each mean, samples per pixel; the resolved scene and the recipe in
the header) and OUT.png beside it, developed as [film] says (opal-render develop makes it anew). Ctrl-C writes what is
there. Until the picture is there, OUT.checkpoint keeps the render's state: whatever ends the render, the same command
with --resume goes on from it. A scene with an [animation] gives OUT.0001.exr, OUT.0002.exr ... and OUT.sheet.png, all frames small on one sheet.

Examples:
  opal-render examples/precious_opal/scene.toml -o out/precious_opal.exr
  opal-render scene.toml -o draft.exr --spp 16 --set render.width=480 --set render.height=360
  opal-render scene.toml -o look.exr --quality preview
  opal-render scene.toml -o lit_from_the_right.exr --set environment.rotate_deg=60 --time 60s)";

/// "60", "60s", "5m", "2h" -> seconds; nothing -> 0.
double parse_duration(const std::string& flag, const std::string& text) {
    if (text.empty()) return 0.0;
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const std::string unit = end;
    const double scale = unit.empty() || unit == "s" ? 1.0 : (unit == "m" ? 60.0 : (unit == "h" ? 3600.0 : 0.0));
    if (!(value > 0.0) || !std::isfinite(value) || scale == 0.0)
        throw InputError(fmt::format("{} {}: expected a positive number of seconds, or with a unit: 90s, 5m, 2h", flag, text));
    return value * scale;
}

}  // namespace

std::filesystem::path RenderOptions::png() const {
    std::filesystem::path path = output;
    return path.replace_extension(".png");
}

std::string RenderOptions::command() const {
    std::string text = "opal-render " + scene_file.string();
    if (!quality.empty()) text += " --quality " + quality;
    for (const std::string& assignment : overrides) text += " --set " + assignment;
    if (samples > 0) text += fmt::format(" --spp {}", samples);
    if (!time.empty()) text += " --time " + time;
    if (noise) text += fmt::format(" --noise {}", *noise);
    if (!crop.empty()) text += " --crop " + crop;
    if (!frames.empty()) text += " --frame " + frames;
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
    app.add_option("--quality", options.quality,
                   "measured settings instead of the scene's: most samples, noise, bounces, odds; --set and the flags below win")
        ->check(CLI::IsMember(quality_names()));
    app.add_option("--spp", options.samples, "samples per pixel, instead of render.samples")->check(CLI::Range(1, 1 << 24));
    app.add_option("--time", options.time, "stop after this long: seconds, or 90s, 5m, 2h");
    app.add_option("--threads", options.threads, "worker threads (default: all cores)")->check(CLI::Range(1, 4096));
    app.add_option("--seed", options.seed, "random seed, instead of render.seed")->check(CLI::Range(std::int64_t(0), INT64_MAX));
    app.add_option("--device", options.device,
                   "what draws the samples: cpu, cuda, or auto (the processor, until cuda has been tried on devices)")
        ->check(CLI::IsMember({"auto", "cpu", "cuda"}));
    app.add_option("--crop", options.crop, "draw pixels x0,y0,x1,y1 alone, the ends not counted, instead of render.crop");
    app.add_option("--frames", options.frames, "of an animation: A:B, both counted, from 1");
    app.add_option("--frame", options.frames, "of an animation: one frame");
    std::string tev;
    CLI::Option* const tev_option =
        app.add_option("--tev", tev, "show the picture while it is made in the viewer tev: host, host:port (default port 14158)");
    app.add_option("--noise", options.noise,
                   "stop where luminance and chroma have this relative error, instead of render.noise; 0: nowhere")
        ->check(number_between(0.0, 1.0));
    std::string samples_of, interval = "60s";
    app.add_option("--samples", samples_of, "draw samples A:B (A <= i < B) of each pixel alone: a part for opal-render merge");
    app.add_option("--checkpoint", interval, "keep the render's state in OUT.checkpoint every so often: 60s, 5m or off")
        ->capture_default_str();
    app.add_flag("--resume", options.checkpoint.resume, "go on from OUT.checkpoint: the result is that of an unbroken render");
    app.add_flag("--keep-checkpoint", options.checkpoint.keep, "keep OUT.checkpoint of a finished render, to add samples later");
    app.add_option("--stats", options.stats_file, "write statistics as JSON");
    if (const std::optional<int> code = parse_command_line(app, argc, argv)) return code;
    if (*tev_option) options.tev = parse_tev_address(tev);
    options.time_limit_s = parse_duration("--time", options.time);
    options.checkpoint.interval_s = interval == "off" ? 0.0 : parse_duration("--checkpoint", interval);
    if (!samples_of.empty()) {
        const std::vector<SampleRange> ranges = parse_sample_ranges(samples_of, "--samples");
        if (ranges.size() > 1) throw InputError(fmt::format("--samples {}: expected one range A:B", samples_of));
        options.samples_of = ranges.front();
    }
    if (options.output.extension() != ".exr")
        throw InputError(fmt::format("output {}: the name must end in .exr", options.output.string()));
    if (options.stats_file == options.output) throw InputError("--stats: names the same file as the picture");
    return std::nullopt;
}

SceneDescription read_scene(const RenderOptions& options) {
    std::vector<std::string> overrides;
    if (!options.quality.empty()) overrides = quality_preset(options.quality).scene_overrides();
    overrides.insert(overrides.end(), options.overrides.begin(), options.overrides.end());
    if (!options.crop.empty()) {
        const PixelWindow window = parse_pixel_window(options.crop);
        overrides.push_back(fmt::format("render.crop=[{}, {}, {}, {}]", window.x0, window.y0, window.x1, window.y1));
    }
    SceneDescription scene = read_scene(options.scene_file, overrides);
    if (options.samples > 0) scene.render.samples = options.samples;
    if (options.seed) scene.render.seed = std::uint64_t(*options.seed);
    if (options.noise) scene.render.noise = *options.noise;
    if (options.samples_of && scene.render.noise > 0.0)
        throw InputError(
            "--samples: how many samples a place needs for --noise (render.noise) is known from all of them alone; a part needs "
            "0");
    if (options.samples_of && int(options.samples_of->end) > scene.render.samples)
        throw InputError(fmt::format("--samples {}:{}: the render has {} samples per pixel (render.samples, --spp)",
                                     options.samples_of->first, options.samples_of->end, scene.render.samples));
    return scene;
}

}  // namespace opal
