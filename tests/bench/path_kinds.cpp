// SPDX-License-Identifier: GPL-3.0-or-later
#include "path_kinds.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

#include "formats/scene.h"
#include "gem_samples.h"
#include "renderer/host/host_scene.h"

namespace opal {
namespace {

constexpr std::size_t levels = 4;
const std::array<const char*, levels> level_names = {"0", "1", "2-3", "4+"};

std::size_t level(std::uint64_t count) {
    return count < 2 ? std::size_t(count) : (count < 4 ? 2 : 3);
}

struct KindSums {
    double paths = 0.0, light = 0.0, square = 0.0;
};
using PixelKinds = std::array<std::array<KindSums, levels>, levels>;

}  // namespace

std::vector<PathKind> path_kinds(const std::filesystem::path& scene_file, const std::filesystem::path& opal, int width,
                                 int samples) {
    const SceneDescription description =
        read_scene(scene_file, {"object.0.file='" + opal.string() + "'", fmt::format("render.width={}", width),
                                fmt::format("render.height={}", width * 3 / 4), "opal.companions=3"});
    std::vector<std::string> notices;
    const HostScene host(description, notices);
    const EmbreeScene intersector(host.meshes());
    const std::vector<std::uint32_t> pixels = gem_pixels(host.view(), intersector);
    std::vector<PixelKinds> sums(pixels.size());
    tbb::parallel_for(std::size_t(0), pixels.size(), [&](std::size_t p) {
        for (int sample = 0; sample < samples; ++sample) {
            PathCounters counters;
            const double luminance = trace_opponent<4>(host.view(), intersector, pixels[p], std::uint32_t(sample), counters)[0];
            KindSums& kind = sums[p][level(counters.scatterings)][level(counters.diffractions - counters.turns_back)];
            kind.paths += 1.0;
            kind.light += luminance;
            kind.square += luminance * luminance;
        }
    });
    std::vector<double> mean(pixels.size(), 0.0);
    double mean_square = 0.0, light = 0.0;
    for (std::size_t p = 0; p < pixels.size(); ++p) {
        for (const auto& row : sums[p])
            for (const KindSums& kind : row) mean[p] += kind.light / samples;
        mean_square += mean[p] * mean[p] / double(pixels.size());
        light += mean[p] * samples;
    }
    std::vector<PathKind> kinds;
    double total = 0.0;
    for (std::size_t s = 0; s < levels; ++s)
        for (std::size_t d = 0; d < levels; ++d) {
            PathKind kind{level_names[s], level_names[d]};
            for (std::size_t p = 0; p < pixels.size(); ++p) {
                const KindSums& of_pixel = sums[p][s][d];
                kind.paths += of_pixel.paths / (double(samples) * double(pixels.size()));
                kind.light += of_pixel.light / light;
                kind.second_moment += of_pixel.square / (mean[p] * mean[p] + 0.01 * mean_square);
            }
            total += kind.second_moment;
            if (kind.paths > 0.0) kinds.push_back(kind);
        }
    for (PathKind& kind : kinds) kind.second_moment /= total;
    std::sort(kinds.begin(), kinds.end(), [](const PathKind& a, const PathKind& b) { return a.second_moment > b.second_moment; });
    return kinds;
}

}  // namespace opal
