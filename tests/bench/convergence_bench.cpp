// SPDX-License-Identifier: GPL-3.0-or-later
#include "convergence_bench.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "formats/atomic_file.h"
#include "formats/command.h"
#include "formats/error.h"
#include "formats/scene.h"
#include "gem_samples.h"
#include "path_kinds.h"
#include "renderer/core/path_tracer.h"
#include "renderer/cpu/light_guides.h"

namespace opal {
namespace {

constexpr int num_seeds = 4;

int bench_width(bool quick) {
    return quick ? 48 : 80;
}
int most_samples(bool quick) {
    return quick ? 64 : 256;
}

struct Setting {
    std::string name, sampler;
    int companions;
    bool guided;
};

const std::vector<Setting> settings = {
    {"one wavelength", "independent", 0, false},          {"3 companions", "independent", 3, false},
    {"3 companions, stratified", "stratified", 3, false}, {"3 companions, sobol", "sobol", 3, false},
    {"3 companions, sobol, guided", "sobol", 3, true},    {"7 companions, sobol, guided", "sobol", 7, true},
};

template <int N>
Opponent trace_uncounted(const SceneView& view, const EmbreeScene& intersector, std::uint32_t pixel, std::uint32_t sample) {
    PathCounters counters;
    return trace_opponent<N>(view, intersector, pixel, sample, counters);
}

using Tracer = decltype(&trace_uncounted<1>);

Tracer tracer_for(int companions) {
    if (companions == 0) return trace_uncounted<1>;
    return companions <= 3 ? trace_uncounted<4> : trace_uncounted<8>;
}

/// Sums over the seeds of one pixel's mean and its square.
struct PixelSums {
    Opponent sum = {}, square = {};
};

/// Errors after some number of samples.
struct ErrorRow {
    int samples = 0;
    double seconds = 0.0;
    double luminance = 0.0, luminance_se = 0.0, chroma = 0.0, chroma_se = 0.0;
};

/// Mean over the pixels of the mean square error over (squared luminance + 1 % of its mean over the pixels). Estimates have no
/// bias, so that their variance between seeds is their mean square error; the standard errors are those of means of 16 groups of
/// pixels. `luminance`: of the pixels, from renders of their own.
ErrorRow error_row(const std::vector<PixelSums>& pixels, const std::vector<double>& luminance) {
    constexpr std::size_t groups = 16;
    double mean_square = 0.0;
    for (const double y : luminance) mean_square += y * y / double(luminance.size());
    std::array<std::array<double, 2>, groups> group = {};
    for (std::size_t p = 0; p < pixels.size(); ++p) {
        std::array<double, 3> variance;
        for (std::size_t k = 0; k < 3; ++k)
            variance[k] = (pixels[p].square[k] - pixels[p].sum[k] * pixels[p].sum[k] / num_seeds) / (num_seeds - 1);
        const double weight = 1.0 / ((luminance[p] * luminance[p] + 0.01 * mean_square) * double(pixels.size()));
        group[p * groups / pixels.size()][0] += weight * variance[0];
        group[p * groups / pixels.size()][1] += weight * (variance[1] + variance[2]);
    }
    std::array<double, 2> total = {}, error = {};
    for (const auto& sums : group)
        for (std::size_t k = 0; k < 2; ++k) total[k] += sums[k];
    for (const auto& sums : group)
        for (std::size_t k = 0; k < 2; ++k) error[k] += std::pow(sums[k] - total[k] / groups, 2.0) * groups / (groups - 1.0);
    ErrorRow row;
    row.luminance = total[0];
    row.luminance_se = std::sqrt(error[0]);
    row.chroma = total[1];
    row.chroma_se = std::sqrt(error[1]);
    return row;
}

/// One setting's renders of a scene, after 4, 8, 16 ... samples.
struct Measured {
    std::vector<std::vector<PixelSums>> pixels;
    std::vector<int> samples;
    std::vector<double> seconds;
};

/// An opal in some light.
struct LitOpal {
    std::filesystem::path scene, opal;
    std::string environment;
};

Measured measure(const LitOpal& lit, const Setting& setting, int width, int samples, std::uint64_t first_seed = 1000) {
    const SceneDescription description =
        read_scene(lit.scene, {"object.0.file='" + lit.opal.string() + "'", "environment.kind=" + lit.environment,
                               fmt::format("render.width={}", width), fmt::format("render.height={}", width * 3 / 4),
                               "render.sampler=" + setting.sampler, fmt::format("opal.companions={}", setting.companions),
                               fmt::format("render.guided={}", setting.guided)});
    std::vector<std::string> notices;
    const HostScene host(description, notices);
    const EmbreeScene intersector(host.meshes());
    const Stopwatch watch;
    const LightGuides guides(host, intersector);
    const std::vector<std::uint32_t> pixels = gem_pixels(host.view(), intersector);
    const Tracer trace = tracer_for(setting.companions);
    std::vector<std::array<Opponent, num_seeds>> sums(pixels.size());
    Measured measured;
    int done = 0;
    for (int end = 4; end <= samples; end *= 2) {
        tbb::parallel_for(std::size_t(0), pixels.size(), [&](std::size_t p) {
            for (int seed = 0; seed < num_seeds; ++seed) {
                SceneView view = guides.scene();
                view.seed = first_seed + std::uint64_t(seed);
                for (int sample = done; sample < end; ++sample) {
                    const Opponent found = trace(view, intersector, pixels[p], std::uint32_t(sample));
                    for (std::size_t k = 0; k < 3; ++k) sums[p][std::size_t(seed)][k] += found[k];
                }
            }
        });
        done = end;
        std::vector<PixelSums> moments(pixels.size());
        for (std::size_t p = 0; p < pixels.size(); ++p)
            for (const Opponent& of_seed : sums[p])
                for (std::size_t k = 0; k < 3; ++k) {
                    const double mean = of_seed[k] / done;
                    moments[p].sum[k] += mean;
                    moments[p].square[k] += mean * mean;
                }
        measured.pixels.push_back(std::move(moments));
        measured.samples.push_back(done);
        measured.seconds.push_back(watch.seconds() / num_seeds);
    }
    return measured;
}

/// The curve of errors of every setting. `reference`: drawn with other seeds than any of them; pictures that are weighted by
/// their own noise seem quieter than others.
std::vector<std::vector<ErrorRow>> error_curves(const std::vector<Measured>& all, const Measured& reference) {
    std::vector<double> luminance;
    for (const PixelSums& pixel : reference.pixels.back()) luminance.push_back(pixel.sum[0] / num_seeds);
    std::vector<std::vector<ErrorRow>> curves;
    for (const Measured& measured : all) {
        curves.emplace_back();
        for (std::size_t i = 0; i < measured.pixels.size(); ++i) {
            curves.back().push_back(error_row(measured.pixels[i], luminance));
            curves.back().back().samples = measured.samples[i];
            curves.back().back().seconds = measured.seconds[i];
        }
    }
    return curves;
}

/// Where a curve of errors over some cost comes down to `error`: between its points, and beyond them by the last two, in
/// logarithms.
double cost_at_error(const std::vector<ErrorRow>& rows, const std::function<double(const ErrorRow&)>& error_of,
                     const std::function<double(const ErrorRow&)>& cost_of, double error) {
    std::size_t i = 1;
    while (i + 1 < rows.size() && error_of(rows[i]) > error) ++i;
    const double x0 = std::log(cost_of(rows[i - 1])), x1 = std::log(cost_of(rows[i]));
    const double y0 = std::log(error_of(rows[i - 1])), y1 = std::log(error_of(rows[i]));
    return std::exp(x0 + (x1 - x0) * (std::log(error) - y0) / (y1 - y0));
}

void build_opal(const std::filesystem::path& recipe, const std::filesystem::path& opal) {
    const std::string command = fmt::format("'{}' build '{}' -o '{}' > /dev/null", OPAL_MODEL, recipe.string(), opal.string());
    if (std::system(command.c_str()) != 0) throw SystemError("failed: " + command);
}

/// Measures all settings and adds their rows to the tables.
void compare_settings(const std::string& scene, const LitOpal& lit, bool quick, std::ofstream& curves, std::ofstream& ratios) {
    const int width = bench_width(quick), samples = most_samples(quick);
    std::vector<Measured> measured;
    for (const Setting& setting : settings) measured.push_back(measure(lit, setting, width, samples));
    const Measured reference = measure(lit, settings[1], width, 2 * samples, 2000);
    const std::vector<std::vector<ErrorRow>> errors = error_curves(measured, reference);
    const ErrorRow& last = errors.front().back();
    for (std::size_t i = 0; i < settings.size(); ++i) {
        for (const ErrorRow& row : errors[i])
            curves << fmt::format("{},{},\"{}\",{},{:.4g},{:.4g},{:.2g},{:.4g},{:.2g}\n", scene, lit.environment,
                                  settings[i].name, row.samples, row.seconds, row.luminance, row.luminance_se, row.chroma,
                                  row.chroma_se);
        const auto ratio = [&](const auto& error_of, const auto& cost_of) {
            return cost_of(last) / cost_at_error(errors[i], error_of, cost_of, error_of(last));
        };
        const auto luminance = [](const ErrorRow& row) { return row.luminance; };
        const auto chroma = [](const ErrorRow& row) { return row.chroma; };
        const auto cost_samples = [](const ErrorRow& row) { return double(row.samples); };
        const auto cost_seconds = [](const ErrorRow& row) { return row.seconds; };
        const std::string line = fmt::format("{},{},\"{}\",{:.3g},{:.3g},{:.3g},{:.3g}", scene, lit.environment, settings[i].name,
                                             ratio(luminance, cost_samples), ratio(chroma, cost_samples),
                                             ratio(luminance, cost_seconds), ratio(chroma, cost_seconds));
        ratios << line << '\n';
        fmt::print("{}\n", line);
        std::fflush(stdout);
    }
}

}  // namespace

void bench_convergence(const std::filesystem::path& folder, bool quick) {
    std::filesystem::create_directories(folder);
    AtomicFile curves_file(folder / "convergence.csv"), ratios_file(folder / "convergence_ratios.csv"),
        kinds_file(folder / "convergence_paths.csv");
    std::ofstream curves(curves_file.temporary_path()), ratios(ratios_file.temporary_path()), kinds(kinds_file.temporary_path());
    kinds << "scene,scatterings,diffractions,paths,light,second_moment\n";
    curves << "scene,light,setting,samples,seconds,relmse_luminance,relmse_luminance_se,relmse_chroma,relmse_chroma_se\n";
    ratios << "scene,light,setting,samples_ratio_luminance,samples_ratio_chroma,time_ratio_luminance,time_ratio_chroma\n";
    for (const std::string scene : {"precious_opal", "white_opal", "fire_opal"}) {
        const std::filesystem::path example = std::filesystem::path(OPAL_EXAMPLES) / scene;
        const std::filesystem::path opal = std::filesystem::absolute(folder) / (scene + ".vdb");
        build_opal(example / "recipe.toml", opal);
        for (const std::string environment : {"studio", "tent"})
            compare_settings(scene, {example / "scene.toml", opal, environment}, quick, curves, ratios);
        for (const PathKind& kind : path_kinds(example / "scene.toml", opal, bench_width(quick), 4 * most_samples(quick)))
            kinds << fmt::format("{},{},{},{:.4f},{:.4f},{:.4f}\n", scene, kind.scatterings, kind.diffractions, kind.paths,
                                 kind.light, kind.second_moment);
        std::filesystem::remove(opal);
    }
    for (std::ofstream* stream : {&curves, &ratios, &kinds}) {
        stream->close();
        if (!*stream) throw SystemError(fmt::format("{}: writing failed", folder.string()));
    }
    curves_file.commit();
    ratios_file.commit();
    kinds_file.commit();
}

}  // namespace opal
