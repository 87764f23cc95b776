// SPDX-License-Identifier: GPL-3.0-or-later
#include "pareto_bench.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "formats/atomic_file.h"
#include "formats/command.h"
#include "formats/error.h"
#include "formats/scene.h"
#include "gem_samples.h"
#include "opal_builds.h"
#include "picture_error.h"
#include "renderer/cpu/light_guides.h"
#include "renderer/host/scene_copy.h"
#include "spectral_lines.h"
#include "variants.h"

namespace opal {
namespace {

/// A patch of so many pixels on a side is about as large as a grain.
constexpr int patch_edge = 4;

struct Extent {
    int width, seeds, samples;  ///< samples per pixel and seed
};

double thread_processor_s() {
    timespec time = {};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

std::vector<std::string> scene_settings(const ParetoVariant& variant, const std::filesystem::path& opal, int width) {
    std::vector<std::string> settings = {"object.0.file='" + opal.string() + "'", fmt::format("render.width={}", width),
                                         fmt::format("render.height={}", width * 3 / 4), "render.filter=box"};
    settings.insert(settings.end(), variant.scene.begin(), variant.scene.end());
    return settings;
}

/// A variant in memory, and what has been drawn of it.
class Subject {
  public:
    Subject(const ParetoScene& scene, const ParetoVariant& variant, const OpalBuild& opal, int width)
        : description_(read_scene(scene.scene, scene_settings(variant, opal.file, width))),
          host_(description_, notices_),
          intersector_(host_.meshes()),
          guides_(host_, intersector_),
          lines_(host_.view().spectra, variant.spectral),
          load_s_(watch_.seconds()) {}

    std::vector<std::uint32_t> pixels() const { return gem_pixels(host_.view(), intersector_); }
    std::size_t memory_bytes() const { return scene_memory(guides_.scene()).total_bytes(); }
    double load_s() const { return load_s_; }
    const SeedPictures& pictures() const { return pictures_; }
    /// Processor time of each seed, per sample.
    const std::vector<double>& sample_s() const { return sample_s_; }

    /// Draws the pixels once more, with another seed.
    void draw(const std::vector<std::uint32_t>& pixels, int samples, std::uint64_t seed) {
        const int lanes = host_.view().wavelengths;
        if (lanes == 1)
            draw_lanes<1>(pixels, samples, seed);
        else if (lanes <= 4)
            draw_lanes<4>(pixels, samples, seed);
        else
            draw_lanes<8>(pixels, samples, seed);
    }

  private:
    template <int N>
    void draw_lanes(const std::vector<std::uint32_t>& pixels, int samples, std::uint64_t seed) {
        SceneView view = guides_.scene();
        view.seed = seed;
        lines_.confine(view.spectra);
        std::vector<Opponent> means(pixels.size());
        std::atomic<double> processor_s = 0.0;
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels.size(), 4),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              const double begin_s = thread_processor_s();
                              for (std::size_t p = range.begin(); p < range.end(); ++p)
                                  means[p] = mean_of_pixel<N>(view, pixels[p], samples);
                              processor_s += thread_processor_s() - begin_s;
                          });
        pictures_.push_back(std::move(means));
        sample_s_.push_back(processor_s / double(pixels.size()) / samples);
    }

    template <int N>
    Opponent mean_of_pixel(const SceneView& view, std::uint32_t pixel, int samples) const {
        Opponent mean = {};
        PathCounters counters;
        for (int sample = 0; sample < samples; ++sample) {
            PathWavelengths<N> wavelengths;
            const PathResult<N> result = trace_sample(view, intersector_, pixel, std::uint32_t(sample), wavelengths, counters);
            Xyz sum{0.0, 0.0, 0.0};
            for (int i = 0; i < wavelengths.count; ++i) {
                const Xyz color = lines_.color(view.spectra, wavelengths.wavelength_nm[i], wavelengths.pdf_per_nm[i]);
                const double radiance = double(result.radiance.v[i]) / wavelengths.count;
                sum = {sum.x + radiance * color.x, sum.y + radiance * color.y, sum.z + radiance * color.z};
            }
            const Opponent found = opponent_of(sum);
            for (std::size_t c = 0; c < 3; ++c) mean[c] += found[c] / samples;
        }
        return mean;
    }

    const Stopwatch watch_;
    std::vector<std::string> notices_;
    const SceneDescription description_;
    const HostScene host_;
    const EmbreeScene intersector_;
    const LightGuides guides_;
    const SpectralLines lines_;
    const double load_s_;
    SeedPictures pictures_;
    std::vector<double> sample_s_;
};

Estimate mean_of(const std::vector<double>& values) {
    Estimate estimate;
    for (const double value : values) estimate.value += value / double(values.size());
    double square = 0.0;
    for (const double value : values) square += (value - estimate.value) * (value - estimate.value);
    estimate.standard_error = std::sqrt(square / double(values.size()) / double(values.size() - 1));
    return estimate;
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
        subjects.push_back(std::make_unique<Subject>(scene, variant, builds.build(scene, variant), extent.width));
        if (variant.exact) exact = subjects.back().get();
    }
    const std::vector<std::uint32_t> pixels = exact->pixels();
    for (int seed = 0; seed < extent.seeds; ++seed)
        for (const auto& subject : subjects) subject->draw(pixels, extent.samples, 5000 + std::uint64_t(seed));
    const Patches patches = patches_of(pixels, extent.width, patch_edge);
    std::vector<std::string> rows;
    for (std::size_t i = 0; i < variants.size(); ++i)
        rows.push_back(row(scene, variants[i], builds.build(scene, variants[i]), *subjects[i], *exact, patches, extent.samples));
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
            if (!only.empty() && std::find(only.begin(), only.end(), variants.front().choice) == only.end()) continue;
            for (const std::string& line : measure_choice(scene, variants, builds, extent)) csv << line;
            fmt::print("{:6.0f} s  {}: {}\n", watch.seconds(), scene.name, variants.front().choice);
            std::fflush(stdout);
        }
    csv.close();
    if (!csv) throw SystemError(fmt::format("{}: writing failed", (folder / "pareto.csv").string()));
    file.commit();
}

}  // namespace opal
