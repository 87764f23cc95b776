// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/scene.h"
#include "renderer/render_options.h"

namespace opal {

/// Header attribute of a frame: "no" where the user stopped its render.
inline constexpr const char* finished_attribute = "opal:finished";

/// Renders the frames of a scene's [animation] (all, or those of options.frames) one after another, each as the still that
/// scene_of_frame makes of it, into OUT.0001.exr ... and draws the contact sheet OUT.sheet.png. With --resume, frames that are
/// there, finished and of this very scene are left as they are, and a frame that was stopped goes on from its checkpoint. Throws
/// what render_still does.
void render_animation(const RenderOptions& options, const SceneDescription& scene);

}  // namespace opal
