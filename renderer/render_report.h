// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "formats/scene.h"
#include "renderer/checkpoint_keeper.h"
#include "renderer/cpu/render_picture.h"
#include "renderer/device_choice.h"

namespace opal {

/// Seconds of the stages around rendering.
struct StageSeconds {
    double tables = 0.0;   ///< light, colours and spectra
    double objects = 0.0;  ///< reading and preparing them
    double rays = 0.0;     ///< building what rays are traced against
    double writing = 0.0;  ///< channels beside the colour, EXR and PNG
};

/// What `--stats` writes: seconds per stage, peak memory, counts, energy per wavelength, versions, the resolved scene.
nlohmann::json render_report(const SceneDescription& scene, const HostScene& host, const RenderOutcome& outcome, const Film& film,
                             const CheckpointKeeper& keeper, const StageSeconds& stages, int threads, const DeviceChoice& device);

}  // namespace opal
