// SPDX-License-Identifier: Apache-2.0
#include "formats/animation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "formats/error.h"
#include "formats/text.h"
#include "formats/units.h"

namespace opal {
namespace {

/// Turns a point counter-clockwise, seen from above, about the vertical axis through `center`.
std::array<double, 3> turned_about(const std::array<double, 3>& point, const std::array<double, 3>& center, double angle_deg) {
    const double angle = units::rad_from_deg(angle_deg), c = std::cos(angle), s = std::sin(angle);
    const double x = point[0] - center[0], y = point[1] - center[1];
    return {center[0] + c * x - s * y, center[1] + s * x + c * y, point[2]};
}

void turn_light(LightDescription& light, const std::array<double, 3>& center, double angle_deg) {
    light.position_mm = turned_about(light.position_mm, center, angle_deg);
    light.target_mm = turned_about(light.target_mm, center, angle_deg);
    light.up = turned_about(light.up, {0.0, 0.0, 0.0}, angle_deg);
    light.azimuth_deg += angle_deg;
}

bool on_turntable(const AnimationDescription& animation, const ObjectDescription& object) {
    const std::vector<std::string>& names = animation.turntable_objects;
    if (names.empty()) return object.kind == ObjectKind::opal;
    return std::find(names.begin(), names.end(), object.name) != names.end();
}

int whole_number(std::string_view text, const std::string& all) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        throw InputError(fmt::format("--frames {}: expected A:B, both counted, or one number", all));
    return value;
}

}  // namespace

AnimationDescription read_animation(TomlSection section) {
    const NumberRange angle = NumberRange::between(-360.0, 360.0);
    AnimationDescription animation;
    animation.frames = static_cast<int>(section.integer("frames", animation.frames, 1, 100'000));
    animation.turntable_deg = section.number("turntable_deg", 0.0, angle);
    animation.turntable_objects = section.texts("turntable_objects");
    animation.center_mm = section.vector3("center_mm", animation.center_mm, NumberRange::between(-1.0e7, 1.0e7));
    animation.light_sweep_deg = section.number("light_sweep_deg", 0.0, angle);
    animation.camera_orbit_deg = section.number("camera_orbit_deg", 0.0, angle);
    section.finish();
    return animation;
}

std::string animation_to_toml(const AnimationDescription& animation) {
    if (animation.frames == 1) return {};
    std::vector<std::string> names;
    for (const std::string& name : animation.turntable_objects) names.push_back(toml_quoted(name));
    return fmt::format(
        "\n[animation]\nframes = {}\nturntable_deg = {}\nturntable_objects = [{}]\ncenter_mm = [{}]\nlight_sweep_deg = {}\n"
        "camera_orbit_deg = {}\n",
        animation.frames, animation.turntable_deg, join(names), fmt::join(animation.center_mm, ", "), animation.light_sweep_deg,
        animation.camera_orbit_deg);
}

SceneDescription scene_of_frame(const SceneDescription& scene, int frame) {
    const AnimationDescription& animation = scene.animation;
    SceneDescription still = scene;
    still.animation = {};
    for (const std::string& name : animation.turntable_objects)
        if (std::none_of(scene.objects.begin(), scene.objects.end(),
                         [&](const ObjectDescription& object) { return object.name == name; }))
            throw InputError(fmt::format("animation.turntable_objects: no [[object]] has the name '{}'", name));
    const double turn_deg = animation.turntable_deg * (frame - 1);
    if (turn_deg != 0.0)
        for (ObjectDescription& object : still.objects) {
            if (!on_turntable(animation, object)) continue;
            object.translate_mm = turned_about(object.translate_mm, animation.center_mm, turn_deg);
            // Rotations about X, then Y, then Z: one more turn about Z simply adds.
            object.rotate_deg[2] += turn_deg;
        }
    const double sweep_deg = animation.light_sweep_deg * (frame - 1);
    still.environment.rotate_deg += sweep_deg;
    if (sweep_deg != 0.0)
        for (LightDescription& light : still.lights) turn_light(light, animation.center_mm, sweep_deg);
    const double orbit_deg = animation.camera_orbit_deg * (frame - 1);
    if (orbit_deg != 0.0) {
        still.camera.position_mm = turned_about(scene.camera.position_mm, scene.camera.target_mm, orbit_deg);
        still.camera.up = turned_about(scene.camera.up, {0.0, 0.0, 0.0}, orbit_deg);
    }
    return still;
}

std::filesystem::path frame_path(const std::filesystem::path& output, int frame) {
    std::filesystem::path path = output;
    return path.replace_extension(fmt::format(".{:04}{}", frame, output.extension().string()));
}

FrameRange parse_frames(const std::string& text, int frames) {
    const std::size_t colon = text.find(':');
    const std::string_view all = text;
    FrameRange range;
    range.first = whole_number(all.substr(0, colon), text);
    range.last = colon == std::string::npos ? range.first : whole_number(all.substr(colon + 1), text);
    if (range.first < 1 || range.last < range.first || range.last > frames)
        throw InputError(fmt::format("--frames {}: the scene has frames 1 to {}", text, frames));
    return range;
}

}  // namespace opal
