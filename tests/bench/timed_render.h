// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "renderer/cpu/render_picture.h"

namespace opal {

struct TimedRender {
    Image image;
    std::vector<std::string> notices;  ///< that loading gave
    RenderOutcome outcome;
    double processor_s = 0.0;   ///< of all threads, for the paths alone
    int reciprocal_points = 0;  ///< of the scene's opal
    double film_bytes = 0.0;    ///< of the film's sums and counts and of the picture made from them

    double processor_us_per_path() const { return 1.0e6 * processor_s / double(outcome.new_samples); }
    double clock_us_per_path() const { return 1.0e6 * outcome.seconds / double(outcome.new_samples); }
};

/// Processor seconds that this process has used.
double processor_seconds();

/// Renders a scene given as TOML on so many threads; 0: all cores.
TimedRender timed_render(const std::string& scene_toml, int samples, int threads = 0);

}  // namespace opal
