// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

namespace opal {

/// A point on the chart of speed against accuracy: settings of both programs that go together, and what they promise. Where the
/// numbers come from: docs/speed-and-accuracy.md.
struct QualityPreset {
    std::string name;
    int samples = 0;     ///< per pixel, at most
    double noise = 0.0;  ///< at which a place gets no more of them; see RenderDescription::noise
    int max_bounces = 0;
    double max_odds = 0.0;
    double for_pixels = 0.0;  ///< of opal-model build --for: how far off the surface's voxels may be
    double mean_error = 0.0;  ///< promised: of the mean luminance of any gem, relative, by these settings without the noise

    /// As overrides of scene.toml: "key=value".
    std::vector<std::string> scene_overrides() const;
};

/// draft, preview, final, reference.
std::span<const QualityPreset> quality_presets();

/// Throws InputError with the names there are.
const QualityPreset& quality_preset(const std::string& name);

/// For help texts and checks.
std::vector<std::string> quality_names();

}  // namespace opal
