// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "renderer/cpu/embree_scene.h"
#include "renderer/host/film.h"
#include "renderer/host/host_scene.h"

namespace opal {

struct RenderLimits {
    int samples = 256;    ///< per pixel
    double time_s = 0.0;  ///< stop after this long (a started pass is finished); 0: no limit
};

struct RenderOutcome {
    PathCounters counters;
    SpectrumTotals totals;
    double seconds = 0.0;
    bool interrupted = false;
    int finished_samples = 0;  ///< passes over the whole picture
};

/// Renders a scene on all CPU cores: TBB over tiles, pass after pass, so that whatever ends it leaves a whole picture. The film's
/// content depends on the scene alone, not on threads. `progress` gets the fraction done.
RenderOutcome render_cpu(const HostScene& scene, const EmbreeScene& intersector, const RenderLimits& limits, Film& film,
                         const std::function<void(double)>& progress);

}  // namespace opal
