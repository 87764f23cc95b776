// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <memory>

#include "formats/atomic_file.h"
#include "formats/command.h"
#include "formats/error.h"
#include "formats/film_settings.h"
#include "formats/report.h"
#include "formats/text.h"
#include "formats_generated/version.h"
#include "renderer/checkpoint_keeper.h"
#include "renderer/cpu/aovs.h"
#include "renderer/cpu/render_picture.h"
#include "renderer/device_choice.h"
#include "renderer/host/development.h"
#include "renderer/host/film_noise.h"
#include "renderer/host/film_parts.h"
#include "renderer/host/film_preview.h"
#include "renderer/host/live_view.h"
#include "renderer/host/render_fingerprint.h"
#include "renderer/host/render_warnings.h"
#include "renderer/render_animation.h"
#include "renderer/render_command.h"
#include "renderer/render_options.h"
#include "renderer/render_report.h"
#include "renderer/render_still.h"

namespace opal {
namespace {

std::map<std::string, std::string> picture_attributes(const RenderOptions& options, const SceneDescription& scene,
                                                      const HostScene& host, Xyz white) {
    return {{"opal:command", options.command()},
            {"opal:scene", scene_to_toml(scene)},
            {film_attribute, film_to_toml(scene.film)},
            {"opal:recipe", host.recipe_toml()},
            {"opal:white", fmt::format("xy {:.5f} {:.5f} is neutral: RGB is adapted from it to D65 by Bradford's matrix",
                                       chromaticity_of(white).x, chromaticity_of(white).y)},
            {"opal:version", OPAL_VERSION_STRING},
            {"Software", std::string("opal-render ") + OPAL_VERSION_STRING}};
}

/// What makes a picture of some samples mergeable.
void add_part(const std::string& fingerprint, const SampleRange& range, int all_samples, const Film& film, Image& image) {
    image.attributes[samples_attribute] = sample_ranges_text({range});
    image.attributes[all_samples_attribute] = std::to_string(all_samples);
    image.attributes[fingerprint_attribute] = fingerprint;
    add_exact_sums(film, image);
}

/// What a later run needs to know a frame of an animation as done.
void mark_frame(const std::string& fingerprint, bool interrupted, Image& image) {
    image.attributes[fingerprint_attribute] = fingerprint;
    image.attributes[finished_attribute] = interrupted ? "no" : "yes";
}

/// The viewer's window, where one is wanted and answers.
std::unique_ptr<LiveView> live_view(const RenderOptions& options, const Film& film) {
    if (!options.tev) return nullptr;
    auto view = std::make_unique<LiveView>(*options.tev, options.output.filename().string(), [&] { return film_preview(film); });
    if (!view->connected())
        fmt::print(stderr, "opal-render: note: no viewer answers at {}:{}; rendering without\n", options.tev->host,
                   options.tev->port);
    return view;
}

/// "noise 0.031, 121000 paths/s"
std::string progress_note(const RenderProgress& progress, const Film& film) {
    const std::optional<PictureNoise> noise = picture_noise(film);
    return fmt::format("{}{:.3g} paths/s", noise ? fmt::format("noise {:.2g}, ", noise->median.larger()) : "",
                       progress.paths_per_second);
}

/// "256", or where places differ "48.3 (32 at least)".
std::string samples_text(const RenderOutcome& outcome, const Film& film) {
    const double mean = double(film.total_samples()) / (double(film.width()) * double(film.height()));
    return mean == outcome.finished_samples ? std::to_string(outcome.finished_samples)
                                            : fmt::format("{:.1f} (at least {})", mean, outcome.finished_samples);
}

/// ", noise 0.021 (95 % of the picture below 0.048)", of the larger of luminance and chroma; nothing where it is not known.
std::string noise_text(const Film& film) {
    const std::optional<PictureNoise> noise = picture_noise(film);
    if (!noise) return "";
    return fmt::format(", noise {:.2g} (95 % of the picture below {:.2g})", noise->median.larger(),
                       noise->percentile_95.larger());
}

void print_summary(const RenderOptions& options, const SceneDescription& scene, const RenderOutcome& outcome, const Film& film) {
    const PathCounters& counters = outcome.counters;
    const PixelWindow window = scene.render.window();
    fmt::print("{}{} and {}: {}x{}, {} samples per pixel{}, {} ({:.0f} paths/s); truncated paths {}, lost {}, NaN {}\n",
               outcome.interrupted ? "interrupted; wrote what is there: " : "", options.output.string(),
               options.png().filename().string(), window.width(), window.height(), samples_text(outcome, film), noise_text(film),
               format_duration(outcome.seconds), double(outcome.new_samples) / std::max(1.0e-9, outcome.seconds),
               counters.truncated_paths, counters.lost_paths, counters.not_a_number);
    for (const std::string& warning : render_warnings(counters, film.total_samples(), scene.render.max_bounces))
        fmt::print(stderr, "opal-render: warning: {}\n", warning);
}

}  // namespace

StillResult render_still(const RenderOptions& options, const SceneDescription& scene, OpalCache& opals) {
    const DeviceChoice device = choose_device(options.device);
    require_writable(options.output);
    require_writable(options.png());
    if (!options.stats_file.empty()) require_writable(options.stats_file);
    const int threads = int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));

    StageSeconds stages;
    Stopwatch watch;
    std::vector<std::string> notices;
    const HostScene host(scene, notices, &opals);
    stages.tables = host.tables_seconds();
    stages.objects = watch.seconds() - stages.tables;
    watch = {};
    const EmbreeScene intersector(host.meshes());
    stages.rays = watch.seconds();
    for (const std::string& notice : notices) fmt::print(stderr, "opal-render: note: {}\n", one_line(notice));

    const Xyz white = film_white(scene.film);
    const SampleRange range = options.samples_of.value_or(SampleRange{0, std::uint32_t(scene.render.samples)});
    const std::string fingerprint = render_fingerprint(scene);
    Film film(scene.render.window(), scene.render.width, scene.render.height, scene.film.spectral, white, range.first);
    CheckpointKeeper keeper(options.checkpoint, options.output, fmt::format("{}first sample = {}\n", fingerprint, range.first),
                            film);
    keeper.find_earlier(int(range.end));
    keeper.start();
    RenderOutcome outcome;
    {
        const std::unique_ptr<LiveView> live = live_view(options, film);
        Progress progress("rendering");
        outcome = render_picture(
            host, intersector, {int(range.end), options.time_limit_s, scene.render.noise}, film,
            [&](const RenderProgress& p) { progress.update(p.fraction, [&] { return progress_note(p, film); }); },
            device_maker(device, host.meshes()));
    }
    keeper.stop();
    if (film.total_samples() == 0) throw Interrupted();

    watch = {};
    Image image = film.to_image();
    add_aovs(host, intersector, scene.film.aovs, image);
    image.attributes.merge(picture_attributes(options, scene, host, white));
    if (!options.frames.empty()) mark_frame(fingerprint, outcome.interrupted, image);
    if (options.samples_of) add_part(fingerprint, range, scene.render.samples, film, image);
    Image display = developed(image, scene.film, scene.film, options.output.string());
    try {
        write_exr(options.output, image);
        write_png(options.png(), display);
    } catch (const std::exception& error) {
        keeper.rescue(error);
    }
    keeper.remove_or_keep(outcome.interrupted);
    stages.writing = watch.seconds();
    if (!options.stats_file.empty())
        write_report(options.stats_file, render_report(scene, host, outcome, film, keeper, stages, threads, device));
    print_summary(options, scene, outcome, film);
    return {std::move(display), outcome.interrupted};
}

int command_render(int argc, char** argv) {
    RenderOptions options;
    if (const std::optional<int> code = parse_render_options(argc, argv, options)) return *code;
    const SceneDescription scene = read_scene(options);
    std::optional<tbb::global_control> limit;
    if (options.threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(options.threads));
    catch_interrupts();
    if (scene.animation.frames > 1) {
        render_animation(options, scene);
        return 0;
    }
    if (!options.frames.empty()) throw InputError(fmt::format("--frames {}: the scene has no [animation]", options.frames));
    OpalCache opals;
    render_still(options, scene, opals);
    return 0;
}

}  // namespace opal
