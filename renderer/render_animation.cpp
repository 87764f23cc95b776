// SPDX-License-Identifier: Apache-2.0
#include "renderer/render_animation.h"

#include <fmt/format.h>

#include "formats/animation.h"
#include "formats/atomic_file.h"
#include "renderer/host/contact_sheet.h"
#include "renderer/render_still.h"

namespace opal {
namespace {

RenderOptions options_of_frame(const RenderOptions& options, int frame) {
    RenderOptions still = options;
    still.output = frame_path(options.output, frame);
    still.frames = std::to_string(frame);
    if (!options.stats_file.empty()) still.stats_file = frame_path(options.stats_file, frame);
    return still;
}

}  // namespace

void render_animation(const RenderOptions& options, const SceneDescription& scene) {
    const int frames = scene.animation.frames;
    const FrameRange range = options.frames.empty() ? FrameRange{1, frames} : parse_frames(options.frames, frames);
    const PixelWindow window = scene.render.window();
    std::filesystem::path sheet_path = options.output;
    sheet_path.replace_extension(".sheet.png");
    require_writable(sheet_path);
    ContactSheet sheet(range.last - range.first + 1, window.width(), window.height());
    for (int frame = range.first; frame <= range.last; ++frame) {
        const StillResult still = render_still(options_of_frame(options, frame), scene_of_frame(scene, frame));
        sheet.add(still.display, std::to_string(frame));
        if (still.interrupted) break;
    }
    if (range.last > range.first) write_png(sheet_path, sheet.image());
}

}  // namespace opal
