// SPDX-License-Identifier: GPL-3.0-or-later
#include "pareto_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "formats/atomic_file.h"
#include "formats/command.h"
#include "formats/error.h"
#include "opal_builds.h"
#include "picture_error.h"
#include "subject.h"
#include "variants.h"

namespace opal {
namespace {

/// A patch of so many pixels on a side is about as large as a grain.
constexpr int patch_edge = 4;

struct Extent {
    int width, seeds, samples;  ///< samples per pixel and seed
};

std::vector<std::string> scene_settings(const ParetoVariant& variant, const std::filesystem::path& opal, int width) {
    std::vector<std::string> settings = {"object.0.file='" + opal.string() + "'", fmt::format("render.width={}", width),
                                         fmt::format("render.height={}", width * 3 / 4), "render.filter=box"};
    settings.insert(settings.end(), variant.scene.begin(), variant.scene.end());
    return settings;
}

std::string render_command(const ParetoScene& scene, const ParetoVariant& variant) {
    if (variant.spectral != SpectralChoice::continuous) return "opal-bench pareto (fixed wavelengths are there alone)";
    std::string text =
        fmt::format("opal-render '{}' -o {}.exr --set object.0.file={}.vdb", scene.scene.string(), scene.name, scene.name);
    for (const std::string& assignment : variant.scene) text += fmt::format(" --set '{}'", assignment);
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
    "squared_error,squared_error_se,mean_error,mean_error_se,memory_bytes,file_bytes,build_s,load_s,command\n";

/// One line of the table. Cost: processor time of a million pixels whose luminance and chroma together are noisy by 10 %.
std::string row(const ParetoScene& scene, const ParetoVariant& variant, const OpalBuild& opal, const Subject& subject,
                const Subject& exact, const Patches& patches, int samples) {
    const SeedPictures exact_patches = patch_means(exact.pictures(), patches);
    const Estimate bias = squared_bias(patch_means(subject.pictures(), patches), exact_patches, relative_weights(exact_patches));
    const Estimate noise = seed_variance(subject.pictures(), relative_weights(exact.pictures()));
    const Estimate mean = relative_mean_error(subject.pictures(), exact.pictures());
    const Estimate sample_s = mean_of(subject.sample_s());
    constexpr double pixels = 1e6, squared_noise = 0.01;
    const double cost_s = sample_s.value * noise.value * samples * pixels / squared_noise;
    const double cost_se = cost_s * std::hypot(noise.standard_error / noise.value, sample_s.standard_error / sample_s.value);
    return fmt::format(
        "{},{},{},{},{:.4g},{:.2g},{:.4g},{:.2g},{:.4g},{:.2g},{:.4g},{:.2g},{:.4g},{:.2g},{},{},{:.3g},{:.3g},{}\n", scene.name,
        variant.choice, quoted(variant.name), variant.exact ? 1 : 0, 1e6 * sample_s.value, 1e6 * sample_s.standard_error,
        noise.value * samples, noise.standard_error * samples, cost_s, cost_se, bias.value, bias.standard_error, mean.value,
        mean.standard_error, subject.memory_bytes(), opal.bytes, opal.processor_s, subject.load_s(),
        quoted(OpalBuilds::command(scene, variant) + " && " + render_command(scene, variant)));
}

/// All values of one choice, seed by seed in turn, so that what disturbs the machine disturbs all alike.
std::vector<std::string> measure_choice(const ParetoScene& scene, const std::vector<ParetoVariant>& variants, OpalBuilds& builds,
                                        const Extent& extent) {
    std::vector<std::unique_ptr<Subject>> subjects;
    const Subject* exact = nullptr;
    for (const ParetoVariant& variant : variants) {
        subjects.push_back(std::make_unique<Subject>(
            scene.scene, scene_settings(variant, builds.build(scene, variant).file, extent.width), variant.spectral));
        if (variant.exact) exact = subjects.back().get();
    }
    const std::vector<std::uint32_t> pixels = exact->pixels();
    const int samples = scene.varies ? extent.samples / 4 : extent.samples;  // the block takes as much longer
    for (int seed = 0; seed < extent.seeds; ++seed)
        for (const auto& subject : subjects) subject->draw(pixels, samples, 5000 + std::uint64_t(seed));
    const Patches patches = patches_of(pixels, extent.width, patch_edge);
    std::vector<std::string> rows;
    for (std::size_t i = 0; i < variants.size(); ++i)
        rows.push_back(row(scene, variants[i], builds.build(scene, variants[i]), *subjects[i], *exact, patches, samples));
    return rows;
}

}  // namespace

void bench_pareto(const std::filesystem::path& folder, bool quick, const std::vector<std::string>& only) {
    std::filesystem::create_directories(folder);
    const Extent extent = quick ? Extent{20, 4, 48} : Extent{40, 8, 128};
    AtomicFile file(folder / "pareto.csv");
    std::ofstream csv(file.temporary_path());
    csv << header;
    OpalBuilds builds(folder / "pareto_opals");
    const Stopwatch watch;
    for (const ParetoScene& scene : pareto_scenes(OPAL_EXAMPLES, OPAL_BENCH_BLOCK, quick))
        for (const std::vector<ParetoVariant>& variants : pareto_choices(scene, quick)) {
            const auto wanted = [&](const std::string& name) { return std::find(only.begin(), only.end(), name) != only.end(); };
            if (!only.empty() && !wanted(scene.name) && !wanted(variants.front().choice)) continue;
            for (const std::string& line : measure_choice(scene, variants, builds, extent)) csv << line;
            csv.flush();
            fmt::print("{:6.0f} s  {}: {}\n", watch.seconds(), scene.name, variants.front().choice);
            std::fflush(stdout);
        }
    csv.close();
    if (!csv) throw SystemError(fmt::format("{}: writing failed", (folder / "pareto.csv").string()));
    file.commit();
}

}  // namespace opal
