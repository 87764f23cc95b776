// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../renderer/on_backends.h"
#include "../renderer/small_opal.h"
#include "formats/animation.h"
#include "formats/film_settings.h"
#include "formats/scene.h"
#include "renderer/host/image_comparison.h"
#include "run_program.h"

namespace opal {
namespace {

constexpr int width = 40, height = 30, samples = 32;

/// A scene of examples/ and the recipes of its opals, in the order of its objects.
struct Example {
    const char* scene;
    std::vector<const char*> recipes;
    int frame = 0;  ///< of an animation
};

const Example all_examples[] = {{"precious_opal/scene.toml", {"precious_opal/recipe.toml"}},
                                {"fire_opal/scene.toml", {"fire_opal/recipe.toml"}},
                                {"white_opal/scene.toml", {"white_opal/recipe.toml"}},
                                {"ring/scene.toml", {"ring/recipe.toml"}},
                                {"teapots/scene.toml", {"teapots/light_blue.toml", "teapots/pink.toml"}},
                                {"turntable/scene.toml", {"precious_opal/recipe.toml"}, 8},
                                {"media_checks/glass.toml", {}},
                                {"media_checks/milk.toml", {}},
                                {"media_checks/cloudy.toml", {}}};

/// The examples' opals, each built once.
class ExamplePictures : public OnBackends {
  protected:
    static void SetUpTestSuite() { folder_ = new ScratchFolder; }
    static void TearDownTestSuite() { delete folder_; }

    static std::string opal_of(const std::string& recipe) {
        std::string name = recipe;
        std::replace(name.begin(), name.end(), '/', '_');
        const std::string file = (*folder_ / (name + ".vdb")).string();
        if (!std::filesystem::exists(file)) {
            const ProgramResult built = run_program(opal_model + " build " + examples + "/" + recipe + " -o " + file);
            EXPECT_EQ(built.exit_code, 0) << built.err;
        }
        return file;
    }

    static SceneDescription scene_of(const Example& example) {
        std::vector<std::string> overrides = {fmt::format("render.width={}", width), fmt::format("render.height={}", height)};
        for (std::size_t i = 0; i < example.recipes.size(); ++i)
            overrides.push_back(fmt::format("object.{}.file=\"{}\"", i, opal_of(example.recipes[i])));
        const SceneDescription scene = read_scene(examples + "/" + example.scene, overrides);
        return example.frame > 0 ? scene_of_frame(scene, example.frame) : scene;
    }

    static Image picture(const SceneDescription& scene, const HostScene& host, const EmbreeScene& rays, const char* backend) {
        Film film(scene.render.window(), width, height, false, film_white(scene.film));
        const RenderOutcome outcome = render_picture(
            host, rays, {samples, 0.0, 0.0}, film, [](const RenderProgress&) {}, backend_maker(backend, host.meshes()));
        EXPECT_EQ(outcome.counters.not_a_number, 0u);
        EXPECT_EQ(outcome.devices.empty(), std::string(backend) == "cpu");
        return film.to_image();
    }

    static ScratchFolder* folder_;
};

ScratchFolder* ExamplePictures::folder_ = nullptr;

/// Mean difference of a channel over its standard error, from how the pixels' differences scatter.
struct PairedTest {
    double z = 0.0;
    double relative_error = 0.0;  ///< standard error of the mean difference over the mean
};
PairedTest paired_test(const Image& a, const Image& b, int channel) {
    double sum = 0.0, squares = 0.0, mean = 0.0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double difference = double(a.pixel(x, y)[channel]) - double(b.pixel(x, y)[channel]);
            sum += difference;
            squares += difference * difference;
            mean += double(b.pixel(x, y)[channel]);
        }
    if (squares == 0.0) return {};
    return {sum / std::sqrt(squares), std::sqrt(squares) / mean};
}

/// Expected share beyond, of about as many independent pixels, and 4 standard errors of it.
double most_beyond(double share) {
    return share + 4.0 * std::sqrt(share / double(width * height));
}

/// The processor's picture and a device's, from the same random numbers: most paths are the same in both, and those that are not,
/// because rays or mathematics round otherwise, differ with mean 0. So pixels differ by no more than independent pictures do, and
/// the mean of the differences is known far better than from independent ones.
TEST_P(ExamplePictures, OfProcessorAndDeviceAgree) {
    for (const Example& example : all_examples) {
        SCOPED_TRACE(example.scene);
        const SceneDescription scene = scene_of(example);
        std::vector<std::string> notices;
        const HostScene host(scene, notices);
        const EmbreeScene rays(host.meshes());
        const Image by_cores = picture(scene, host, rays, "cpu"), by_device = picture(scene, host, rays, GetParam());
        const ImageComparison comparison = compare_images(by_device, by_cores, 0.0);
        ASSERT_TRUE(comparison.noise_test);
        const NoiseTest& noise = *comparison.noise_test;
        // Shares of a normal distribution; with variances from 32 samples each, of Student's, 62 degrees of freedom.
        EXPECT_LT(noise.beyond_2_sigma, most_beyond(0.050));
        EXPECT_LT(noise.beyond_3_sigma, most_beyond(0.0039));
        EXPECT_LT(noise.beyond_4_sigma, most_beyond(0.00018));
        for (int c = 0; c < 3; ++c) {
            const PairedTest paired = paired_test(by_device, by_cores, by_cores.find_channel(std::string(1, "RGB"[c])));
            EXPECT_LT(std::abs(noise.mean_z[c]), 4.0) << c;
            EXPECT_LT(std::abs(paired.z), 4.0) << c;
            std::printf("%s %c: beyond 2, 3, 4: %.2f %.3f %.4f %%; z %.2f; paired z %.2f, standard error %.3f %%\n",
                        example.scene, "RGB"[c], 100.0 * noise.beyond_2_sigma, 100.0 * noise.beyond_3_sigma,
                        100.0 * noise.beyond_4_sigma, noise.mean_z[c], paired.z, 100.0 * paired.relative_error);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(, ExamplePictures, testing::Values("loop", "cuda"), backend_name);

}  // namespace
}  // namespace opal
