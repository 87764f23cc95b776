// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "formats/quality.h"
#include "small_opal.h"

namespace opal {
namespace {

struct PromiseScene {
    const char* name;
    SmallOpal opal;
    std::string environment;
};

/// Gems that the presets were not chosen on: one where odds matter, in the studio's light, one where bounces do, in uniform
/// light, where little else makes noise.
std::vector<PromiseScene> promise_scenes() {
    SmallOpal dark, milky;
    dark.constants.sphere_diameter_nm = 320.0;
    dark.constants.n_medium = 1.40;
    dark.constants.sigma_a_per_mm = SampledSpectrum{{380.0, 780.0}, {0.4, 0.25}};
    milky.grains = 80;
    milky.constants.sphere_diameter_nm = 260.0;
    milky.constants.sigma_s_mie_per_mm = 0.25;
    milky.constants.sigma_a_per_mm = SampledSpectrum{{380.0, 780.0}, {0.02, 0.02}};
    return {{"dark", dark, "studio"}, {"milky", milky, "constant"}};
}

/// Mean luminance of the gem's middle, one value per seed.
std::vector<double> means(const PromiseScene& scene, const QualityPreset& preset) {
    constexpr int num_seeds = 8, edge = 24, samples = 40;
    const ScratchFolder folder;
    write_opal_asset(scene.opal.make(), folder / "opal.vdb");
    std::vector<double> means;
    for (int seed = 0; seed < num_seeds; ++seed) {
        const Rendered rendered = render_text(
            "[render]\nwidth = 24\nheight = 24\nfilter = \"box\"\nseed = " + std::to_string(100 + seed) +
                "\nmax_bounces = " + std::to_string(preset.max_bounces) +
                "\n[camera]\nposition_mm = [0, -20, 12]\ntarget_mm = [0, 0, 0]\nvertical_fov_deg = 10\n[opal]\nmax_odds = " +
                std::to_string(preset.max_odds) + "\n[environment]\nkind = \"" + scene.environment +
                "\"\n[[object]]\nkind = \"opal\"\nfile = '" + (folder / "opal.vdb").string() + "'\n",
            samples);
        double luminance = 0.0;
        const char* const channels[3] = {"R", "G", "B"};
        const double weights[3] = {0.2126, 0.7152, 0.0722};
        for (int c = 0; c < 3; ++c) luminance += weights[c] * region_mean(rendered.image, channels[c], 0, 0, edge, edge).mean;
        means.push_back(luminance);
    }
    return means;
}

/// What a preset's settings change of a gem's mean is within its promise, noise apart: against the settings of `reference`, drawn
/// with the same numbers.
TEST(Quality, SettingsKeepTheirPromises) {
    const QualityPreset& exact = quality_preset("reference");
    for (const PromiseScene& scene : promise_scenes()) {
        const std::vector<double> reference = means(scene, exact);
        for (const QualityPreset& preset : quality_presets()) {
            if (preset.name == exact.name) continue;
            const std::vector<double> found = means(scene, preset);
            double sum = 0.0, square = 0.0, total = 0.0;
            for (std::size_t k = 0; k < found.size(); ++k) {
                sum += found[k] - reference[k];
                square += std::pow(found[k] - reference[k], 2.0);
                total += reference[k];
            }
            const double n = double(found.size());
            const double error = sum / total;
            const double standard_error = std::sqrt((square - sum * sum / n) * n / (n - 1.0)) / total;
            EXPECT_LT(std::abs(error), preset.mean_error + 3.0 * standard_error) << scene.name << ", " << preset.name;
            RecordProperty(std::string(scene.name) + "_" + preset.name,
                           std::to_string(error) + " +- " + std::to_string(standard_error));
            EXPECT_LT(standard_error, 0.02) << scene.name << ", " << preset.name << ": too noisy to say anything";
        }
    }
}

}  // namespace
}  // namespace opal
