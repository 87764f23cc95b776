// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "renderer/cpu/embree_scene.h"
#include "renderer/host/film.h"
#include "renderer/host/host_scene.h"
#include "renderer/host/path_device.h"

namespace opal {

struct RenderLimits {
    int samples = 256;    ///< per pixel: its samples from the film's first up to this one, not counted, are drawn
    double time_s = 0.0;  ///< stop after this long, but not before every pixel has a sample; 0: no limit
    double noise = 0.0;   ///< a block ends when its luminance and its chroma are as quiet as this, see film_noise.h; 0: none does
};

struct RenderOutcome {
    PathCounters counters;
    SpectrumTotals totals;
    double seconds = 0.0;           ///< of this run
    std::uint64_t new_samples = 0;  ///< drawn in it
    bool interrupted = false;
    int finished_samples = 0;                     ///< that every pixel has
    std::vector<std::string> devices;             ///< that drew them; none: the processor
    std::optional<KernelSeconds> device_seconds;  ///< by the devices' own clocks, of all together
};

/// How far a render has come, and how fast.
struct RenderProgress {
    double fraction = 0.0;  ///< done of what was left to do
    double paths_per_second = 0.0;
};

/// Makes the device that draws the samples of a scene for a film; null: the processor's cores do.
using MakeDevice = std::function<std::unique_ptr<PathDevice>(const SceneView&, const Film&)>;

/// Renders a scene on all CPU cores, or on the device that `make_device` gives, going on from what the film holds: TBB over the
/// film's blocks, pass after pass, so that whatever ends it leaves a picture; blocks then have sample counts of their own. The
/// film's content depends on the scene and the limits alone, not on threads, passes or interruptions. `progress` is called from
/// all threads.
RenderOutcome render_picture(const HostScene& scene, const EmbreeScene& intersector, const RenderLimits& limits, Film& film,
                             const std::function<void(const RenderProgress&)>& progress, const MakeDevice& make_device = {});

}  // namespace opal
