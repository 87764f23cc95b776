// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <tbb/global_control.h>

#include "formats/atomic_file.h"
#include "formats/command.h"
#include "formats/error.h"
#include "formats/illuminant.h"
#include "formats/report.h"
#include "formats_generated/version.h"
#include "renderer/cpu/render_cpu.h"
#include "renderer/host/tone_mapping.h"
#include "renderer/render_command.h"
#include "renderer/render_options.h"
#include "renderer/render_report.h"

namespace opal {
namespace {

std::map<std::string, std::string> picture_attributes(const RenderOptions& options, const SceneDescription& scene,
                                                      const HostScene& host, Xyz white) {
    return {{"opal:command", options.command()},
            {"opal:scene", scene_to_toml(scene)},
            {"opal:recipe", host.recipe_toml()},
            {"opal:white", fmt::format("xy {:.5f} {:.5f} is neutral: RGB is adapted from it to D65 by Bradford's matrix",
                                       chromaticity_of(white).x, chromaticity_of(white).y)},
            {"opal:version", OPAL_VERSION_STRING},
            {"Software", std::string("opal-render ") + OPAL_VERSION_STRING}};
}

void print_summary(const RenderOptions& options, const SceneDescription& scene, const RenderOutcome& outcome, const Film& film) {
    const PathCounters& counters = outcome.counters;
    fmt::print("{}{} and {}: {}x{}, {} samples per pixel, {} ({:.0f} paths/s); truncated paths {}, lost {}, NaN {}\n",
               outcome.interrupted ? "interrupted; wrote what is there: " : "", options.output.string(),
               options.png().filename().string(), scene.render.width, scene.render.height, outcome.finished_samples,
               format_duration(outcome.seconds), double(film.total_samples()) / std::max(1.0e-9, outcome.seconds),
               counters.truncated_paths, counters.lost_paths, counters.not_a_number);
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
}

}  // namespace

int command_render(int argc, char** argv) {
    RenderOptions options;
    if (const std::optional<int> code = parse_render_options(argc, argv, options)) return *code;
    const SceneDescription scene = read_scene(options);
    require_writable(options.output);
    require_writable(options.png());
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
        outcome = render_cpu(host, intersector, {scene.render.samples, options.time_limit_s}, film,
                             [&](double f) { progress.update(f); });
    }
    if (film.total_samples() == 0) throw Interrupted();

    Image image = film.to_image();
    add_aovs(host, intersector, scene.film.aovs, image);
    image.attributes = picture_attributes(options, scene, host, white);
    write_exr(options.output, image);
    write_png(options.png(), tone_mapped(image, scene.film.exposure_ev));
    if (!options.stats_file.empty())
        write_report(options.stats_file, render_report(scene, host, outcome, film, loading_s, threads));
    print_summary(options, scene, outcome, film);
    return 0;
}

}  // namespace opal
