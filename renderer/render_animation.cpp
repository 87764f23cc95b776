// SPDX-License-Identifier: Apache-2.0
#include "renderer/render_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "formats/animation.h"
#include "formats/atomic_file.h"
#include "formats/error.h"
#include "renderer/checkpoint_keeper.h"
#include "renderer/host/contact_sheet.h"
#include "renderer/host/development.h"
#include "renderer/host/film_parts.h"
#include "renderer/host/render_fingerprint.h"
#include "renderer/render_still.h"

namespace opal {
namespace {

RenderOptions options_of_frame(const RenderOptions& options, int frame) {
    RenderOptions still = options;
    still.output = frame_path(options.output, frame);
    still.frames = std::to_string(frame);
    if (!options.stats_file.empty()) still.stats_file = frame_path(options.stats_file, frame);
    std::error_code ignored;
    still.checkpoint.resume = options.checkpoint.resume && std::filesystem::exists(checkpoint_path(still.output), ignored);
    return still;
}

/// Tiles of a sheet that stays below some 16 million pixels.
int tile_px(int count) {
    return std::clamp(int(std::sqrt(1.6e7 / count)), 12, 240);
}

/// The picture of a frame that an earlier run has finished, as its PNG shows it.
std::optional<Image> finished_frame(const std::filesystem::path& path, const SceneDescription& still) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) return std::nullopt;
    Image image;
    try {
        image = read_image(path);
    } catch (const InputError&) {
        return std::nullopt;  // made anew
    }
    const auto is = [&](const char* attribute, const std::string& value) {
        const auto found = image.attributes.find(attribute);
        return found != image.attributes.end() && found->second == value;
    };
    if (!is(finished_attribute, "yes") || !is("opal:scene", scene_to_toml(still)) ||
        !is(fingerprint_attribute, render_fingerprint(still)))
        return std::nullopt;
    return developed(image, still.film, still.film, path.string());
}

}  // namespace

void render_animation(const RenderOptions& options, const SceneDescription& scene) {
    const int frames = scene.animation.frames;
    const FrameRange range = options.frames.empty() ? FrameRange{1, frames} : parse_frames(options.frames, frames);
    const PixelWindow window = scene.render.window();
    std::filesystem::path sheet_path = options.output;
    sheet_path.replace_extension(".sheet.png");
    require_writable(sheet_path);
    const int count = range.last - range.first + 1;
    ContactSheet sheet(count, window.width(), window.height(), tile_px(count));
    OpalCache opals;
    for (int frame = range.first; frame <= range.last; ++frame) {
        const RenderOptions frame_options = options_of_frame(options, frame);
        const SceneDescription frame_scene = scene_of_frame(scene, frame);
        if (options.checkpoint.resume)
            if (const std::optional<Image> display = finished_frame(frame_options.output, frame_scene)) {
                sheet.add(*display, std::to_string(frame));
                fmt::print("{}: finished already\n", frame_options.output.string());
                continue;
            }
        const StillResult still = render_still(frame_options, frame_scene, opals);
        sheet.add(still.display, std::to_string(frame));
        if (still.interrupted) break;
    }
    if (range.last > range.first) write_png(sheet_path, sheet.image());
}

}  // namespace opal
