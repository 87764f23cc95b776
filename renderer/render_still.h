// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/image.h"
#include "formats/scene.h"
#include "renderer/render_options.h"

namespace opal {

/// Renders one picture and writes its EXR, its PNG and, where asked, its statistics. Returns what the PNG shows. Throws
/// InputError, SystemError; Interrupted where the user stopped before there was anything to keep.
struct StillResult {
    Image display;
    bool interrupted = false;  ///< stopped by the user: the picture has fewer samples than asked for
};
StillResult render_still(const RenderOptions& options, const SceneDescription& scene);

}  // namespace opal
