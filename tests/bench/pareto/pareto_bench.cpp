// SPDX-License-Identifier: GPL-3.0-or-later
#include "pareto_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench_chart.h"
#include "double_subject.h"
#include "formats/atomic_file.h"
#include "formats/command.h"
#include "formats/error.h"
#include "opal_builds.h"
#include "picture_error.h"
#include "shell_word.h"
#include "subject.h"
#include "variants.h"

namespace opal {
namespace {

/// A patch of so many pixels on a side is about as large as a grain.
constexpr int patch_edge = 4;

struct Extent {
    int width, seeds, samples;  ///< samples per pixel and seed
    int tent_samples;           ///< the same, in the light tent
};

std::vector<std::string> scene_settings(const ParetoVariant& variant, const std::filesystem::path& opal, int width) {
    std::vector<std::string> settings = {"object.0.file='" + opal.string() + "'", fmt::format("render.width={}", width),
                                         fmt::format("render.height={}", width * 3 / 4), "render.filter=box"};
    settings.insert(settings.end(), variant.scene.begin(), variant.scene.end());
    return settings;
}

std::string render_command(const ParetoScene& scene, const ParetoVariant& variant) {
    if (variant.spectral != SpectralChoice::continuous) return "opal-bench pareto (fixed wavelengths are there alone)";
    if (variant.tracing == Tracing::own_tree_in_double) return "opal-bench pareto (draws with opal-draw-double)";
    if (variant.tracing == Tracing::own_tree) return "opal-bench pareto (opal-render has the tree on devices alone)";
    std::string text = fmt::format("opal-render {} -o {}.exr --set object.0.file={}.vdb",
                                   shell_word(in_project(scene).scene.string()), scene.name, scene.name);
    for (const std::string& assignment : variant.scene) text += " --set " + shell_word(assignment);
    return text;
}

/// A field of a .csv (RFC 4180).
std::string quoted(const std::string& text) {
    std::string field = "\"";
    for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
    return field + '"';
}

constexpr const char* header =
    "scene,choice,variant,exact,processor_us_per_sample,processor_us_se,variance_per_sample,variance_se,cost_s,cost_se,"
    "squared_error,squared_error_se,mean_error,mean_error_se,tent_squared_error,tent_squared_error_se,tent_mean_error,"
    "tent_mean_error_se,memory_bytes,file_bytes,build_s,load_s,command\n";

/// What errors of a scene's pixels are relative to: the default settings, drawn with seeds of their own.
struct SceneLight {
    std::vector<double> luminance;  ///< of every pixel of the picture, 0 beside the gem
    double typical = 0.0;           ///< of those that have any

    /// As one picture of these pixels.
    SeedPictures at(const std::vector<std::uint32_t>& pixels) const {
        SeedPictures pictures(1);
        // The outline of a coarser model may hold a pixel more.
        for (const std::uint32_t pixel : pixels)
            pictures[0].push_back({luminance[pixel] > 0.0 ? luminance[pixel] : typical, 0.0, 0.0});
        return pictures;
    }
};

/// Its light and that in the tent.
struct SceneLights {
    SceneLight own, tent;
};

SceneLight mean_light(const Subject& subject, Lighting lighting, const std::vector<std::uint32_t>& pixels, const Extent& extent) {
    SceneLight light;
    light.luminance.assign(std::size_t(extent.width * extent.width), 0.0);
    for (const auto& picture : subject.pictures(lighting))
        for (std::size_t p = 0; p < pixels.size(); ++p) light.luminance[pixels[p]] += picture[p][0] / extent.seeds;
    for (const std::uint32_t pixel : pixels) light.typical += light.luminance[pixel] / double(pixels.size());
    return light;
}

SceneLights scene_lights(const ParetoScene& scene, OpalBuilds& builds, const Extent& extent) {
    const ParetoVariant settings{"", "default", {}, {}};
    Subject subject(scene.scene, scene_settings(settings, builds.build(scene, settings).file, extent.width),
                    SpectralChoice::continuous);
    const std::vector<std::uint32_t> pixels = subject.pixels();
    for (int seed = 0; seed < extent.seeds; ++seed) {
        subject.draw(pixels, extent.samples, 9000 + std::uint64_t(seed));
        subject.draw(pixels, extent.tent_samples, 9000 + std::uint64_t(seed), Lighting::tent);
    }
    return {mean_light(subject, Lighting::of_the_scene, pixels, extent), mean_light(subject, Lighting::tent, pixels, extent)};
}

/// What the pictures of a variant converge to, apart from those of the exact one: the squared error of patches, that of the mean.
std::string errors(const Drawings& subject, const Drawings& exact, Lighting lighting, const SeedPictures& light,
                   const Patches& patches) {
    const Estimate bias =
        squared_bias(patch_means(subject.pictures(lighting), patches), patch_means(exact.pictures(lighting), patches),
                     relative_weights(patch_means(light, patches)));
    const Estimate mean = relative_mean_error(subject.pictures(lighting), exact.pictures(lighting));
    return fmt::format("{:.4g},{:.2g},{:.4g},{:.2g}", bias.value, bias.standard_error, mean.value, mean.standard_error);
}

/// One line of the table. Cost: processor time of a million pixels whose luminance and chroma together are noisy by 10 %.
std::string row(const ParetoScene& scene, const ParetoVariant& variant, const OpalBuild& opal, const Drawings& subject,
                const Drawings& exact, const SceneLights& lights, const std::vector<std::uint32_t>& pixels,
                const Patches& patches, int samples) {
    const SeedPictures light = lights.own.at(pixels);
    const Estimate noise = seed_variance(subject.pictures(), relative_weights(light));
    const Estimate sample_s = mean_of(subject.sample_s());
    constexpr double million = 1e6, squared_noise = 0.01;
    const double cost_s = sample_s.value * noise.value * samples * million / squared_noise;
    const double cost_se = cost_s * std::hypot(noise.standard_error / noise.value, sample_s.standard_error / sample_s.value);
    return fmt::format("{},{},{},{},{:.4g},{:.2g},{:.4g},{:.2g},{:.4g},{:.2g},{},{},{},{},{:.3g},{:.3g},{}\n", scene.name,
                       variant.choice, quoted(variant.name), variant.exact ? 1 : 0, 1e6 * sample_s.value,
                       1e6 * sample_s.standard_error, noise.value * samples, noise.standard_error * samples, cost_s, cost_se,
                       errors(subject, exact, Lighting::of_the_scene, light, patches),
                       errors(subject, exact, Lighting::tent, lights.tent.at(pixels), patches), subject.memory_bytes(),
                       opal.bytes, opal.processor_s, subject.load_s(),
                       quoted(OpalBuilds::command(scene, variant) + " && " + render_command(scene, variant)));
}

/// All values of one choice, seed by seed in turn, so that what disturbs the machine disturbs all alike.
std::vector<std::string> measure_choice(const ParetoScene& scene, const std::vector<ParetoVariant>& variants, OpalBuilds& builds,
                                        const SceneLights& lights, const Extent& extent) {
    std::vector<std::unique_ptr<Drawings>> subjects;
    const Drawings* exact = nullptr;
    std::vector<std::uint32_t> pixels;  // of the exact one, or of the first where that is drawn elsewhere
    for (const ParetoVariant& variant : variants) {
        const std::vector<std::string> settings = scene_settings(variant, builds.build(scene, variant).file, extent.width);
        if (variant.tracing == Tracing::own_tree_in_double) {
            subjects.push_back(std::make_unique<DoubleSubject>(scene.scene, settings, builds.folder()));
        } else {
            auto subject = std::make_unique<Subject>(scene.scene, settings, variant.spectral, variant.tracing);
            if (pixels.empty() || variant.exact) pixels = subject->pixels();
            subjects.push_back(std::move(subject));
        }
        if (variant.exact) exact = subjects.back().get();
    }
    const int samples = scene.varies ? extent.samples / 4 : extent.samples;  // the block takes as much longer
    for (int seed = 0; seed < extent.seeds; ++seed)
        for (const auto& subject : subjects) {
            subject->draw(pixels, samples, 5000 + std::uint64_t(seed));
            subject->draw(pixels, extent.tent_samples, 5000 + std::uint64_t(seed), Lighting::tent);
        }
    const Patches patches = patches_of(pixels, extent.width, patch_edge);
    std::vector<std::string> rows;
    for (std::size_t i = 0; i < variants.size(); ++i)
        rows.push_back(
            row(scene, variants[i], builds.build(scene, variants[i]), *subjects[i], *exact, lights, pixels, patches, samples));
    return rows;
}

}  // namespace

void bench_pareto(const std::filesystem::path& folder, bool quick, const std::vector<std::string>& only) {
    std::filesystem::create_directories(folder);
    const Extent extent = quick ? Extent{20, 4, 48, 12} : Extent{40, 8, 96, 48};
    AtomicFile file(folder / "pareto.csv");
    std::ofstream csv(file.temporary_path());
    csv << header;
    OpalBuilds builds(folder / "pareto_opals");
    const Stopwatch watch;
    const auto wanted = [&](const std::string& name) {
        return only.empty() || std::find(only.begin(), only.end(), name) != only.end();
    };
    for (const ParetoScene& scene : pareto_scenes(OPAL_EXAMPLES, OPAL_BENCH_BLOCK, quick)) {
        std::optional<SceneLights> lights;
        for (const std::vector<ParetoVariant>& variants : pareto_choices(scene, quick)) {
            if (!wanted(scene.name) && !wanted(variants.front().choice)) continue;
            if (!lights) lights = scene_lights(scene, builds, extent);
            for (const std::string& line : measure_choice(scene, variants, builds, *lights, extent)) csv << line;
            csv.flush();
            fmt::print("{:6.0f} s  {}: {}\n", watch.seconds(), scene.name, variants.front().choice);
            std::fflush(stdout);
        }
    }
    csv.close();
    if (!csv) throw SystemError(fmt::format("{}: writing failed", (folder / "pareto.csv").string()));
    file.commit();
    draw_chart("plot_pareto.py", folder / "pareto.csv");
}

}  // namespace opal
