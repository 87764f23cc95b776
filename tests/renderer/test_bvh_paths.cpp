// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "formats/scene.h"
#include "renderer/core/path_tracer.h"
#include "renderer/host/bvh.h"
#include "renderer/host/host_scene.h"
#include "round_body.h"
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

/// Of the four wavelengths.
double mean_radiance(const PathResult<4>& result) {
    double sum = 0.0;
    for (const float radiance : result.radiance.v) sum += 0.25 * double(radiance);
    return sum;
}

/// The same samples over Embree and over the hierarchy for devices: distances differ in their last bits, which now and then
/// sends a path elsewhere, but never the mean.
template <bool with_pieces>
void expect_embrees_picture(const std::string& scene_toml, std::uint32_t samples) {
    const SceneDescription description = parse_scene(
        "[render]\nwidth = 24\nheight = 24\nsampler = \"independent\"\n"
        "[camera]\nposition_mm = [0, -20, 8]\ntarget_mm = [0, 0, 0]\nvertical_fov_deg = 22\n[environment]\nkind = \"studio\"\n" +
            scene_toml,
        "test.toml", {});
    std::vector<std::string> notices;
    const HostScene host(description, notices);
    const EmbreeScene embree(host.meshes());
    const Bvh bvh(host.meshes());
    ASSERT_EQ(bvh.has_pieces(), with_pieces);
    const BvhView<with_pieces> view = bvh.view<with_pieces>(host.view().meshes);
    constexpr std::uint32_t pixels = 24 * 24;
    PathCounters counters, embree_counters;
    std::uint64_t near = 0;
    Sums differences;
    for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
        Sums of_bvh, of_embree;
        for (std::uint32_t sample = 0; sample < samples; ++sample) {
            PathWavelengths<4> wavelengths;
            const double a = mean_radiance(trace_sample<4>(host.view(), view, pixel, sample, wavelengths, counters));
            const double b = mean_radiance(trace_sample<4>(host.view(), embree, pixel, sample, wavelengths, embree_counters));
            near += std::abs(a - b) <= 1.0e-3 * std::abs(a + b) ? 1 : 0;
            of_bvh.add(a);
            of_embree.add(b);
            differences.add(a - b);
        }
        const auto variance = [&](const Sums& s) { return (s.squares - s.sum * s.sum / samples) / (samples - 1.0) / samples; };
        EXPECT_LE(std::abs(of_bvh.sum - of_embree.sum) / samples,
                  4.0 * std::sqrt(variance(of_bvh) + variance(of_embree)) + 1.0e-6)
            << pixel;
    }
    const double count = double(samples) * pixels;
    EXPECT_LE(std::abs(differences.sum), 4.0 * std::sqrt(differences.squares) + 1.0e-6 * count);
    EXPECT_GE(double(near), 0.9 * count);
    EXPECT_LE(double(counters.lost_paths), count / 1.0e5);
    EXPECT_EQ(counters.not_a_number, 0u);
    testing::Test::RecordProperty("near", std::to_string(double(near) / count));
    testing::Test::RecordProperty("lost", std::to_string(counters.lost_paths) + " " + std::to_string(embree_counters.lost_paths));
    testing::Test::RecordProperty("difference", std::to_string(differences.sum / std::sqrt(differences.squares)));
}

const std::string ground =
    "[[material]]\nname = \"ground\"\nkind = \"diffuse\"\nalbedo = 0.5\n"
    "[[object]]\nkind = \"plane\"\nmaterial = \"ground\"\ntranslate_mm = [0, 0, -3.2]\n";

TEST(Bvh, GivesThePathTracerEmbreesPictures) {
    const ScratchFolder folder;
    SmallOpal small;
    small.constants.sigma_s_mie_per_mm = 0.1;
    write_opal_asset(small.make(), folder / "opal.vdb");
    expect_embrees_picture<false>(ground + "[[object]]\nkind = \"opal\"\nfile = '" + (folder / "opal.vdb").string() + "'\n", 100);
}

TEST(Bvh, GivesThePathTracerEmbreesPicturesOfExactSurfaces) {
    const ScratchFolder folder;
    OpalAsset asset = SmallOpal().make();
    asset.bezier_patches = round_body(2.6, 1.8, 1.2);
    write_opal_asset(asset, folder / "opal.vdb");
    expect_embrees_picture<true>("[opal]\ndiffraction = \"none\"\n" + ground +
                                     "[[object]]\nkind = \"opal\"\nexact = true\nfile = '" + (folder / "opal.vdb").string() +
                                     "'\n",
                                 20);
}

}  // namespace
}  // namespace opal
