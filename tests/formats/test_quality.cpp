// SPDX-License-Identifier: Apache-2.0
#include "formats/quality.h"

#include <gtest/gtest.h>

#include "formats/error.h"
#include "formats/scene.h"

namespace opal {
namespace {

const std::string scene_text =
    "[render]\nsamples = 77\nnoise = 0.9\nmax_bounces = 3\n[opal]\nmax_odds = 5.0\n"
    "[[object]]\nkind = \"opal\"\nfile = \"x.vdb\"\n";

TEST(Quality, PresetsReplaceTheScenesSettings) {
    for (const QualityPreset& preset : quality_presets()) {
        const SceneDescription scene = parse_scene(scene_text, "s.toml", preset.scene_overrides());
        EXPECT_EQ(scene.render.samples, preset.samples);
        EXPECT_EQ(scene.render.noise, preset.noise);
        EXPECT_EQ(scene.render.max_bounces, preset.max_bounces);
        EXPECT_EQ(scene.opal.max_odds, preset.max_odds);
    }
}

TEST(Quality, LaterOverridesWin) {
    std::vector<std::string> overrides = quality_preset("draft").scene_overrides();
    overrides.push_back("render.samples=5");
    EXPECT_EQ(parse_scene(scene_text, "s.toml", overrides).render.samples, 5);
}

TEST(Quality, EachIsFinerThanTheOneBefore) {
    const auto presets = quality_presets();
    ASSERT_EQ(presets.size(), 4u);
    for (std::size_t i = 1; i < presets.size(); ++i) {
        EXPECT_GT(presets[i].samples, presets[i - 1].samples);
        EXPECT_LT(presets[i].noise, presets[i - 1].noise);
        EXPECT_GE(presets[i].max_bounces, presets[i - 1].max_bounces);
        EXPECT_GE(presets[i].max_odds, presets[i - 1].max_odds);
        EXPECT_LE(presets[i].for_pixels, presets[i - 1].for_pixels);
        EXPECT_LT(presets[i].mean_error, presets[i - 1].mean_error);
    }
}

TEST(Quality, UnknownNamesAreToldTheKnownOnes) {
    try {
        quality_preset("finest");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("draft, preview, final, reference"), std::string::npos);
    }
}

}  // namespace
}  // namespace opal
