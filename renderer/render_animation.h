// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/scene.h"
#include "renderer/render_options.h"

namespace opal {

/// Renders the frames of a scene's [animation] (all, or those of options.frames) one after another, each as the still that
/// scene_of_frame makes of it, into OUT.0001.exr ... and draws the contact sheet OUT.sheet.png. Throws what render_still does.
void render_animation(const RenderOptions& options, const SceneDescription& scene);

}  // namespace opal
