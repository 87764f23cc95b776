// SPDX-License-Identifier: Apache-2.0
#include "formats/quality.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "formats/error.h"

namespace opal {
namespace {

const std::array<QualityPreset, 4> presets = {{
    {"draft", 32, 0.5, 24, 25.0, 10.0, 0.15},
    {"preview", 128, 0.25, 32, 100.0, 3.0, 0.08},
    {"final", 1024, 0.1, 64, 400.0, 1.0, 0.03},
    {"reference", 16384, 0.02, 1024, 1600.0, 0.5, 0.005},
}};

}  // namespace

std::vector<std::string> QualityPreset::scene_overrides() const {
    return {fmt::format("render.samples={}", samples), fmt::format("render.noise={}", noise),
            fmt::format("render.max_bounces={}", max_bounces), fmt::format("opal.max_odds={}", max_odds)};
}

std::span<const QualityPreset> quality_presets() {
    return presets;
}

std::vector<std::string> quality_names() {
    std::vector<std::string> names;
    for (const QualityPreset& preset : presets) names.push_back(preset.name);
    return names;
}

const QualityPreset& quality_preset(const std::string& name) {
    for (const QualityPreset& preset : presets)
        if (preset.name == name) return preset;
    throw InputError(fmt::format("--quality: unknown '{}' (there are {})", name, fmt::join(quality_names(), ", ")));
}

}  // namespace opal
