// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/image.h"
#include "formats/scene.h"
#include "renderer/host/opal_cache.h"
#include "renderer/render_options.h"

namespace opal {

struct StillResult {
    Image display;             ///< what the PNG shows
    bool interrupted = false;  ///< stopped by the user: the picture has fewer samples than asked for
};

/// Renders one picture and writes its EXR, its PNG and, where asked, its statistics. `opals` lends opals that it knows. Throws
/// InputError, SystemError; Interrupted where the user stopped before there was anything to keep.
StillResult render_still(const RenderOptions& options, const SceneDescription& scene, OpalCache& opals);

}  // namespace opal
