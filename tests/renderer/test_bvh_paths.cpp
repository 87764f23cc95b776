// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "formats/scene.h"
#include "renderer/core/path_tracer.h"
#include "renderer/host/bvh.h"
#include "renderer/host/host_scene.h"
#include "small_opal.h"

namespace opal {
namespace {

struct Sums {
    double sum = 0.0, squares = 0.0;
    void add(double x) {
        sum += x;
        squares += x * x;
    }
};

/// The same samples over Embree and over the hierarchy for devices: distances differ in their last bits, which now and then
/// sends a path elsewhere, but never the mean.
TEST(Bvh, GivesThePathTracerEmbreesPictures) {
    const ScratchFolder folder;
    SmallOpal small;
    small.constants.sigma_s_mie_per_mm = 0.1;
    write_opal_asset(small.make(), folder / "opal.vdb");
    const SceneDescription description = parse_scene(
        "[render]\nwidth = 24\nheight = 24\nsampler = \"independent\"\n"
        "[camera]\nposition_mm = [0, -20, 8]\ntarget_mm = [0, 0, 0]\nvertical_fov_deg = 22\n[environment]\nkind = \"studio\"\n"
        "[[material]]\nname = \"ground\"\nkind = \"diffuse\"\nalbedo = 0.5\n[[object]]\nkind = \"opal\"\nfile = '" +
            (folder / "opal.vdb").string() +
            "'\n"
            "[[object]]\nkind = \"plane\"\nmaterial = \"ground\"\ntranslate_mm = [0, 0, -3.2]\n",
        "test.toml", {});
    std::vector<std::string> notices;
    const HostScene host(description, notices);
    const EmbreeScene embree(host.meshes());
    const Bvh bvh(host.meshes());
    ASSERT_FALSE(bvh.has_pieces());
    const BvhView<true> view = bvh.view(host.view().meshes);
    constexpr std::uint32_t samples = 100;
    const std::uint32_t pixels = 24 * 24;
    PathCounters counters, embree_counters;
    std::uint64_t near = 0;
    Sums all;
    for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
        Sums of_bvh, of_embree;
        for (std::uint32_t sample = 0; sample < samples; ++sample) {
            PathWavelengths<4> wavelengths;
            const auto mean = [](const PathResult<4>& result) {
                return 0.25 * (double(result.radiance.v[0]) + double(result.radiance.v[1]) + double(result.radiance.v[2]) +
                               double(result.radiance.v[3]));
            };
            const double a = mean(trace_sample<4>(host.view(), view, pixel, sample, wavelengths, counters));
            const double b = mean(trace_sample<4>(host.view(), embree, pixel, sample, wavelengths, embree_counters));
            near += std::abs(a - b) <= 1.0e-3 * std::abs(a + b) ? 1 : 0;
            of_bvh.add(a);
            of_embree.add(b);
            all.add(a - b);
        }
        const auto variance = [](const Sums& s) { return (s.squares - s.sum * s.sum / samples) / (samples - 1.0) / samples; };
        // 576 pixels: one in ten pictures would have a pixel beyond 3.9 by chance, were the samples not the same.
        EXPECT_LE(std::abs(of_bvh.sum - of_embree.sum) / samples,
                  4.0 * std::sqrt(variance(of_bvh) + variance(of_embree)) + 1.0e-6)
            << pixel;
    }
    const double count = double(samples) * pixels;
    EXPECT_LE(std::abs(all.sum), 4.0 * std::sqrt(all.squares) + 1.0e-6 * count);
    EXPECT_GE(double(near), 0.9 * count);
    EXPECT_LE(counters.lost_paths, count / 1.0e5);
    EXPECT_EQ(counters.not_a_number, 0u);
    RecordProperty("near", std::to_string(double(near) / count));
    RecordProperty("lost", std::to_string(counters.lost_paths) + " " + std::to_string(embree_counters.lost_paths));
    RecordProperty("difference", std::to_string(all.sum / std::sqrt(all.squares)));
}

}  // namespace
}  // namespace opal
