// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "formats/scene.h"
#include "renderer/host/film_parts.h"
#include "renderer/host/tev_client.h"

namespace opal {

/// How a render's state is kept.
struct CheckpointOptions {
    double interval_s = 60.0;  ///< 0: no checkpoints
    bool resume = false;
    bool keep = false;  ///< when the render is finished
};

/// The flags of a render.
struct RenderOptions {
    std::filesystem::path scene_file, output, stats_file;
    std::vector<std::string> overrides;
    std::string quality;        ///< a preset between the scene's settings and `overrides`; empty: none
    int samples = 0;            ///< 0: the scene's
    double time_limit_s = 0.0;  ///< 0: none
    std::string time;           ///< as given
    int threads = 0;            ///< 0: all cores
    std::optional<std::int64_t> seed;
    std::string device = "auto";
    std::optional<double> noise;            ///< unset: the scene's
    std::optional<SampleRange> samples_of;  ///< draw these samples alone, as a part of the whole
    CheckpointOptions checkpoint;
    std::string crop;               ///< "x0,y0,x1,y1"; empty: the scene's
    std::string frames;             ///< "A:B" or "N"; empty: all
    std::optional<TevAddress> tev;  ///< the viewer that shows the picture while it is made

    /// The picture for people, beside the output.
    std::filesystem::path png() const;
    /// The command as it decides the picture: without the output's name, threads and statistics, so that the same picture has
    /// the same bytes.
    std::string command() const;
};

/// Parses the command line of a render. Returns an exit code where the command line alone decides (help, version). Throws
/// InputError.
std::optional<int> parse_render_options(int argc, char** argv, RenderOptions& options);

/// The scene with the flags in it. Throws InputError.
SceneDescription read_scene(const RenderOptions& options);

}  // namespace opal
