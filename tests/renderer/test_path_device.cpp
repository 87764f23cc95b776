// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <fstream>

#include "on_backends.h"
#include "renderer/cpu/loop_device.h"
#include "same_film.h"
#include "small_opal.h"

namespace opal {
namespace {

/// A milky opal on a plane under a lamp, drawn by a device: "loop" or "cuda".
class PathDevices : public OnBackends {
  protected:
    static bool cuda() { return std::string(GetParam()) == "cuda"; }

    static void SetUpTestSuite() {
        folder = std::make_unique<ScratchFolder>();
        SmallOpal small;
        small.constants.sphere_diameter_nm = 300.0;
        small.constants.sigma_s_mie_per_mm = 0.2;
        small.constants.sigma_a_per_mm = absorber_spectrum("carbon", 0.2);
        write_opal_asset(small.make(), *folder / "opal.vdb");
        const std::string body =
            "[render]\nwidth = 44\nheight = 30\nmax_bounces = 24\n[film]\nspectral = true\n"
            "[camera]\nposition_mm = [0, -20, 12]\ntarget_mm = [0, 0, 0]\n"
            "[[material]]\nname = \"m\"\n[[object]]\nkind = \"plane\"\nmaterial = \"m\"\ntranslate_mm = [0, 0, -3.1]\n"
            "[[object]]\nkind = \"opal\"\nfile = \"opal.vdb\"\n";
        std::ofstream(*folder / "without_lamp.toml") << body;
        std::ofstream(*folder / "scene.toml")
            << body << "[[light]]\nkind = \"sphere\"\nradius_mm = 2\nposition_mm = [5, -5, 12]\nradiance = 20\n";
    }
    static void TearDownTestSuite() { folder.reset(); }

    /// A scene with what rays need, and a film for a part of its picture.
    struct Scene {
        SceneDescription description;
        std::vector<std::string> notices;
        HostScene host;
        EmbreeScene intersector;
        Bvh bvh;

        explicit Scene(const std::vector<std::string>& overrides = {}, const char* file = "scene.toml")
            : description(read_scene(*folder / file, overrides)),
              host(description, notices),
              intersector(host.meshes()),
              bvh(host.meshes()) {}
        Film film() const { return {description.render.window(), 44, 30, true}; }
        RenderOutcome render(Film& film, RenderLimits limits, bool device) const {
            return render_picture(
                host, intersector, limits, film, [](const RenderProgress&) {},
                backend_maker(device ? GetParam() : "cpu", host.meshes()));
        }
    };

    static inline std::unique_ptr<ScratchFolder> folder;
};

TEST_P(PathDevices, ALaunchAddsUpAsTheFilmDoes) {
    if (cuda()) GTEST_SKIP() << "its mathematics rounds otherwise: see PicturesOfCoresAndDeviceAgree";
    const Scene scene({"render.crop=[3,2,42,29]"});
    Film expected = scene.film(), found = scene.film();
    const BvhView<true> rays = scene.bvh.view<true>(scene.host.view().meshes);
    for (int b = 0; b < expected.num_blocks(); ++b) {
        FilmBlock& block = expected.block(b);
        const PixelWindow pixels = expected.block_window(b), window = expected.window();
        for (; block.end_sample < 18; ++block.end_sample)
            for (int y = pixels.y0; y < pixels.y1; ++y)
                for (int x = pixels.x0; x < pixels.x1; ++x) {
                    PathWavelengths<4> wavelengths;
                    const PathResult<4> result =
                        trace_sample(scene.host.view(), rays, std::uint32_t(44 * (window.y0 + y) + window.x0 + x),
                                     block.end_sample, wavelengths, block.counters);
                    expected.add(scene.host.view().spectra, std::uint32_t(y * expected.width() + x),
                                 film_sample(wavelengths, result), block.totals);
                }
    }
    LoopDevice device(scene.host.view(), scene.bvh, found);
    std::vector<int> all, some;
    for (int b = 0; b < found.num_blocks(); ++b) (b % 3 == 0 ? some : all).push_back(b);
    device.advance(found, all, 18);
    device.advance(found, some, 5);
    device.advance(found, some, 13);
    // Compiled in two places: the one may fuse a product and a sum where the other does not.
    expect_same_film(expected, found, 1.0e-13);
    EXPECT_GT(expected.block(7).counters.diffractions, 0u);
    std::uint64_t truncated = 0;
    for (int b = 0; b < expected.num_blocks(); ++b) truncated += expected.block(b).counters.truncated_paths;
    EXPECT_GT(truncated, 0u);
}

TEST_P(PathDevices, OneLaneAndEight) {
    for (const char* companions : {"opal.companions=0", "opal.companions=6"}) {
        const Scene scene({companions});
        Film by_cores = scene.film(), by_device = scene.film();
        scene.render(by_cores, {8, 0.0, 0.0}, false);
        scene.render(by_device, {8, 0.0, 0.0}, true);
        // Rays meet triangles within a float's rounding of the same place: most paths are the same.
        int equal = 0;
        for (std::uint32_t p = 0; p < 44u * 30u; ++p)
            equal += std::abs(by_cores.sums(p)[1] - by_device.sums(p)[1]) <= 1.0e-3 * by_cores.sums(p)[1] ? 1 : 0;
        EXPECT_GT(equal, 44 * 30 / 2) << companions;
    }
}

TEST_P(PathDevices, SameBitsWithAnyThreadsAndLaunches) {
    const Scene scene;
    Film one = scene.film(), many = scene.film();
    const RenderLimits limits{96, 0.0, 0.2};
    {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
        scene.render(one, limits, true);
    }
    // In three runs, as after two interruptions.
    scene.render(many, {7, 0.0, 0.2}, true);
    scene.render(many, {40, 0.0, 0.2}, true);
    const RenderOutcome outcome = scene.render(many, limits, true);
    // Several devices add up their shares of each launch: where it was cut shows in the last bits.
    expect_same_film(one, many, outcome.devices.size() > 1 ? 1.0e-12 : 0.0);
    int settled = 0;
    for (int b = 0; b < one.num_blocks(); ++b) settled += one.block(b).settled ? 1 : 0;
    EXPECT_GT(settled, 0);
    EXPECT_LT(settled, one.num_blocks());
}

TEST_P(PathDevices, PicturesOfCoresAndDeviceAgree) {
    const Scene scene({"environment.kind=constant"}, "without_lamp.toml");
    Film by_cores = scene.film(), by_device = scene.film();
    const RenderOutcome cores = scene.render(by_cores, {128, 0.0, 0.0}, false);
    const Scene other({"environment.kind=constant", "render.seed=2"}, "without_lamp.toml");
    const RenderOutcome device = other.render(by_device, {128, 0.0, 0.0}, true);
    // 400 to 670 nm: few wavelengths are drawn beyond.
    for (int bin = 4; bin < 32; bin += 3) {
        const auto mean = [&](const SpectrumTotals& totals) { return totals.radiance[bin] / double(totals.samples); };
        const auto variance = [&](const SpectrumTotals& totals) {
            return totals.radiance_squared[bin] / double(totals.samples) / double(totals.samples);
        };
        const double error = std::sqrt(variance(cores.totals) + variance(device.totals));
        EXPECT_NEAR(mean(cores.totals), mean(device.totals), 4.0 * error) << bin;
        EXPECT_LT(error, 0.05 * mean(cores.totals)) << bin;
    }
}

INSTANTIATE_TEST_SUITE_P(, PathDevices, testing::Values("loop", "cuda"), backend_name);

}  // namespace
}  // namespace opal
