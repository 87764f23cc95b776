// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "on_backends.h"
#include "small_opal.h"

namespace opal {
namespace {

/// Those that end with Loop are short enough to run in the devices' loop, too.
class SeveralOpals : public OnBackends {};
class SeveralOpalsLoop : public OnBackends {};

std::string opal_at(const std::filesystem::path& file, double x_mm, int priority) {
    return "[[object]]\nkind = \"opal\"\nfile = '" + file.string() + "'\ntranslate_mm = [" + std::to_string(x_mm) +
           ", 0, 0]\npriority = " + std::to_string(priority) + "\n";
}

std::string small_scene(const std::string& camera, const std::string& environment) {
    return "[render]\nwidth = 40\nheight = 40\nsampler = \"independent\"\nfilter = \"box\"\n[camera]\n" + camera +
           "vertical_fov_deg = 20\n[environment]\n" + environment;
}

const std::string from_the_side = "position_mm = [0, -20, 5]\ntarget_mm = [0, 0, 0]\n";

MeanEstimate mean_of(const Rendered& rendered) {
    return region_mean(rendered.image, "G", 0, 0, 40, 40);
}

void expect_same_light(const Rendered& a, const Rendered& b, const std::string& what) {
    const MeanEstimate first = mean_of(a), second = mean_of(b);
    const double error = std::hypot(first.standard_error, second.standard_error);
    EXPECT_NEAR(first.mean, second.mean, 4.0 * error) << what;
    EXPECT_LT(error, 0.005 * first.mean) << what << ": too noisy to say anything";
}

struct TwoFiles {
    ScratchFolder folder;
    std::filesystem::path dense = folder / "dense.vdb", light = folder / "light.vdb";

    TwoFiles() {
        SmallOpal small;
        small.radius_mm = 1.5;
        small.constants.sigma_a_per_mm = SampledSpectrum{{380.0, 780.0}, {0.4, 0.1}};
        small.constants.n_sphere = 1.9;
        small.constants.n_medium = 1.7;
        write_opal_asset(small.make(), dense);
        SmallOpal larger;
        larger.radius_mm = 3.0;
        larger.constants.sigma_s_mie_per_mm = 0.3;
        write_opal_asset(larger.make(), light);
    }
};

TEST_P(SeveralOpals, OverlappingOnesAreInvisibleUnderUniformLight) {
    const ScratchFolder folder;
    SmallOpal first, second;
    first.constants.sphere_diameter_nm = 300.0;
    second.constants.sphere_diameter_nm = 260.0;
    second.constants.n_sphere = 1.6;
    second.constants.n_medium = 1.5;
    second.constants.sigma_s_mie_per_mm = 0.2;
    write_opal_asset(first.make(), folder / "first.vdb");
    write_opal_asset(second.make(), folder / "second.vdb");
    for (const int priority : {-1, 0, 1}) {
        const Rendered rendered =
            render_text(small_scene(from_the_side, "kind = \"constant\"\n") + opal_at(folder / "first.vdb", -1.0, 0) +
                            opal_at(folder / "second.vdb", 1.0, priority),
                        64, GetParam());
        const MeanEstimate mean = mean_of(rendered);
        const double truncated = rendered.outcome.totals.truncated_rgb[1] / double(rendered.outcome.totals.samples);
        EXPECT_NEAR(mean.mean + truncated, 1.0, 4.0 * mean.standard_error) << priority;
        EXPECT_LT(mean.standard_error, 0.008) << "too noisy to say anything";
        EXPECT_EQ(rendered.outcome.counters.not_a_number, 0u);
        EXPECT_LE(rendered.outcome.counters.lost_paths, rendered.outcome.totals.samples / 100000);
    }
}

TEST_P(SeveralOpals, OneOfLowerPriorityInsideAnotherIsNotThere) {
    const TwoFiles files;
    const std::string head = small_scene(from_the_side, "kind = \"constant\"\n");
    const Rendered alone = render_text(head + opal_at(files.light, 0.0, 0), 96, GetParam());
    const Rendered hidden = render_text(head + opal_at(files.dense, 0.4, -1) + opal_at(files.light, 0.0, 0), 96, GetParam());
    expect_same_light(alone, hidden, "hidden");
    const Rendered seen = render_text(head + opal_at(files.dense, 0.4, 1) + opal_at(files.light, 0.0, 0), 96, GetParam());
    const MeanEstimate first = mean_of(alone), second = mean_of(seen);
    EXPECT_GT(std::abs(first.mean - second.mean), 8.0 * std::hypot(first.standard_error, second.standard_error))
        << "of higher priority it changes the picture";
}

TEST_P(SeveralOpals, TheOrderInTheFileDecidesBetweenEqualPriorities) {
    const TwoFiles files;
    const std::string head = small_scene(from_the_side, "kind = \"constant\"\n");
    const Rendered by_order = render_text(head + opal_at(files.light, 0.0, 0) + opal_at(files.dense, 1.5, 0), 64, GetParam());
    const Rendered by_priority = render_text(head + opal_at(files.dense, 1.5, 1) + opal_at(files.light, 0.0, 0), 64, GetParam());
    expect_same_light(by_order, by_priority, "the later object wins");
}

TEST_P(SeveralOpalsLoop, ACameraMayStandInsideTwo) {
    const TwoFiles files;
    // Uniform light: the furnace holds from inside, too, but for what is absorbed.
    SmallOpal small;
    small.radius_mm = 1.5;
    small.constants.n_sphere = 1.9;
    small.constants.n_medium = 1.7;
    write_opal_asset(small.make(), files.dense);
    const Rendered rendered =
        render_text(small_scene("position_mm = [0.3, -0.2, 0.1]\ntarget_mm = [0, 5, 0]\n", "kind = \"constant\"\n") +
                        "[opal]\ndiffraction = \"none\"\n" + opal_at(files.light, 0.0, 0) + opal_at(files.dense, 0.0, 1),
                    128, GetParam());
    const MeanEstimate mean = mean_of(rendered);
    const double truncated = rendered.outcome.totals.truncated_rgb[1] / double(rendered.outcome.totals.samples);
    EXPECT_NEAR(mean.mean + truncated, 1.0, 4.0 * mean.standard_error);
    EXPECT_LT(mean.standard_error, 0.01);
    EXPECT_EQ(rendered.outcome.counters.lost_paths, 0u);
}

INSTANTIATE_TEST_SUITE_P(, SeveralOpals, cpu_and_cuda(), backend_name);
INSTANTIATE_TEST_SUITE_P(, SeveralOpalsLoop, cpu_loop_and_cuda(), backend_name);

}  // namespace
}  // namespace opal
