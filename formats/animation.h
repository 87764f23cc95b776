// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "formats/scene.h"
#include "formats/toml_reader.h"

/// The [animation] section of a scene: turntables, light sweeps and camera orbits, each a steady turn per frame.
namespace opal {

AnimationDescription read_animation(TomlSection section);
/// The section with its header; empty for a still.
std::string animation_to_toml(const AnimationDescription& animation);

/// The still scene of a frame, frames counted from 1: everything has turned `frame - 1` times. Its picture is by definition the
/// frame's. Throws InputError where turntable_objects names an object that is not there.
SceneDescription scene_of_frame(const SceneDescription& scene, int frame);

/// "turn.exr" and frame 7 -> "turn.0007.exr".
std::filesystem::path frame_path(const std::filesystem::path& output, int frame);

/// Frames to draw, both counted.
struct FrameRange {
    int first = 1, last = 1;
};

/// "A:B" with 1 <= A <= B <= frames, or "N". Throws InputError.
FrameRange parse_frames(const std::string& text, int frames);

}  // namespace opal
