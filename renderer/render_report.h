// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "formats/scene.h"
#include "renderer/cpu/render_cpu.h"

namespace opal {

/// What `--stats` writes: seconds per stage, peak memory, counts, energy per wavelength, versions, the resolved scene.
nlohmann::json render_report(const SceneDescription& scene, const HostScene& host, const RenderOutcome& outcome, const Film& film,
                             double loading_s, int threads);

}  // namespace opal
