// SPDX-License-Identifier: Apache-2.0
#include "formats/scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "formats/animation.h"
#include "formats/film_settings.h"
#include "formats/illuminant.h"
#include "formats/scene_lights.h"
#include "formats/scene_objects.h"
#include "formats/text.h"
#include "formats/toml_enum.h"

namespace opal {
namespace {

const std::vector<std::string> sampler_names = {"sobol", "stratified", "independent"};
const std::vector<std::string> light_sampling_names = {"both", "connections", "scattering"};
const std::vector<std::string> filter_names = {"tent", "box", "gaussian", "blackman-harris"};
const std::vector<std::string> camera_names = {"perspective", "orthographic"};
const std::vector<std::string> environment_names = {"studio", "constant", "file", "tent"};
const std::vector<std::string> illuminant_names = {"D65", "A", "E", "blackbody", "led", "file"};
const std::vector<std::string> upsampling_names = {"jakob-hanika", "smits", "basis"};
const std::vector<std::string> diffraction_names = {"two-beam", "ewald-fresnel", "laue", "none"};
const std::vector<std::string> dispersion_names = {"full", "bands", "none"};
const std::vector<std::string> majorant_names = {"local", "global"};
const std::vector<std::string> tracking_names = {"residual", "ratio"};
const std::vector<std::string> grains_names = {"auto", "cells", "voxels", "sphere-tracing", "hyperboloid"};

std::optional<PixelWindow> read_crop(TomlSection& section, int width, int height) {
    if (!section.has("crop")) return std::nullopt;
    const std::vector<std::int64_t> edges = section.integers("crop", 4);
    if (edges[0] < 0 || edges[0] >= edges[2] || edges[2] > width || edges[1] < 0 || edges[1] >= edges[3] || edges[3] > height)
        section.fail("crop",
                     fmt::format("[{}] is no part of the picture; allowed: [x0, y0, x1, y1] with 0 <= x0 < x1 <= {} and 0 "
                                 "<= y0 < y1 <= {}",
                                 fmt::join(edges, ", "), width, height));
    return PixelWindow{int(edges[0]), int(edges[1]), int(edges[2]), int(edges[3])};
}

/// The usual radius of a filter, px.
double default_radius_px(FilterKind filter) {
    switch (filter) {
        case FilterKind::box:
            return 0.5;
        case FilterKind::tent:
            return 1.0;
        case FilterKind::gaussian:
            return 1.5;
        case FilterKind::blackman_harris:
            break;
    }
    return 2.0;
}

RenderDescription read_render(TomlSection section) {
    RenderDescription render;
    render.width = static_cast<int>(section.integer("width", render.width, 1, 65536));
    render.height = static_cast<int>(section.integer("height", render.height, 1, 65536));
    render.samples = static_cast<int>(section.integer("samples", render.samples, 1, 1 << 24));
    render.noise = section.number("noise", render.noise, NumberRange::between(0.0, 1.0));
    render.max_bounces = static_cast<int>(section.integer("max_bounces", render.max_bounces, 1, 1'000'000));
    render.roulette = section.boolean("roulette", render.roulette);
    render.seed = static_cast<std::uint64_t>(section.integer("seed", 1, 0, INT64_MAX));
    render.sampler = enum_choice(section, "sampler", render.sampler, sampler_names);
    render.light_sampling = enum_choice(section, "light_sampling", render.light_sampling, light_sampling_names);
    render.guided = section.boolean("guided", render.guided);
    render.filter = enum_choice(section, "filter", render.filter, filter_names);
    render.filter_radius_px =
        section.number("filter_radius_px", default_radius_px(render.filter), NumberRange::between(0.01, 16.0));
    render.crop = read_crop(section, render.width, render.height);
    section.finish();
    return render;
}

CameraDescription read_camera(TomlSection section) {
    const NumberRange coordinate = NumberRange::between(-1.0e7, 1.0e7);
    CameraDescription camera;
    camera.kind = enum_choice(section, "kind", camera.kind, camera_names);
    camera.position_mm = section.vector3("position_mm", camera.position_mm, coordinate);
    camera.target_mm = section.vector3("target_mm", camera.target_mm, coordinate);
    camera.up = section.vector3("up", camera.up, coordinate);
    camera.vertical_fov_deg = section.number("vertical_fov_deg", camera.vertical_fov_deg, NumberRange::between(0.01, 170.0));
    camera.view_height_mm = section.number("view_height_mm", camera.view_height_mm, NumberRange::positive(1.0e7));
    camera.aperture_radius_mm = section.number("aperture_radius_mm", 0.0, NumberRange::from_zero(1.0e4));
    camera.focus_mm = section.number("focus_mm", 0.0, NumberRange::from_zero(1.0e7));
    if (camera.position_mm == camera.target_mm) section.fail("target_mm", "is where the camera stands");
    std::array<double, 3> view, cross;
    for (int i = 0; i < 3; ++i) view[i] = camera.target_mm[i] - camera.position_mm[i];
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        cross[i] = view[j] * camera.up[k] - view[k] * camera.up[j];
    }
    if (cross == std::array<double, 3>{0.0, 0.0, 0.0}) section.fail("up", "must not point along the view");
    section.finish();
    return camera;
}

EnvironmentDescription read_environment(TomlSection section) {
    EnvironmentDescription environment;
    environment.file = section.path("file");
    const EnvironmentKind fallback = environment.file.empty() ? EnvironmentKind::studio : EnvironmentKind::file;
    environment.kind = enum_choice(section, "kind", fallback, environment_names);
    if (environment.kind == EnvironmentKind::file && environment.file.empty())
        section.fail("file", "kind = \"file\" needs a lat-long image (.exr or .hdr)");
    if (environment.kind != EnvironmentKind::file && !environment.file.empty())
        section.fail("file", "is used with kind = \"file\" only");
    environment.radiance = section.number("radiance", environment.radiance, NumberRange::from_zero(1.0e9));
    environment.rotate_deg = section.number("rotate_deg", 0.0, NumberRange::between(-3.6e4, 3.6e4));
    environment.illuminant_file = section.path("illuminant_file");
    environment.illuminant =
        enum_choice(section, "illuminant", environment.illuminant_file.empty() ? IlluminantKind::d65 : IlluminantKind::file,
                    illuminant_names);
    if ((environment.illuminant == IlluminantKind::file) != !environment.illuminant_file.empty())
        section.fail("illuminant_file", "and illuminant = \"file\" go together: a .csv with wavelength_nm and a relative power");
    if (environment.illuminant == IlluminantKind::blackbody)
        environment.temperature_k =
            section.number("temperature_k", environment.temperature_k, NumberRange::between(1000.0, 25000.0));
    if (environment.illuminant == IlluminantKind::led)
        environment.temperature_k =
            section.number("temperature_k", environment.temperature_k, NumberRange::between(led_min_k, led_max_k));
    section.finish();
    return environment;
}

ColorDescription read_color(TomlSection section) {
    ColorDescription color;
    color.upsampling = enum_choice(section, "upsampling", color.upsampling, upsampling_names);
    section.finish();
    return color;
}

OpalDescription read_opal(TomlSection section) {
    OpalDescription opal;
    opal.diffraction = enum_choice(section, "diffraction", opal.diffraction, diffraction_names);
    opal.grains = enum_choice(section, "grains", opal.grains, grains_names);
    opal.ewald_tolerance = section.number("ewald_tolerance", opal.ewald_tolerance, NumberRange{0.0, 0.5, true});
    opal.max_odds = section.number("max_odds", opal.max_odds, NumberRange::between(1.0, 1.0e6));
    opal.dispersion = enum_choice(section, "dispersion", opal.dispersion, dispersion_names);
    opal.majorants = enum_choice(section, "majorants", opal.majorants, majorant_names);
    opal.tracking = enum_choice(section, "tracking", opal.tracking, tracking_names);
    opal.companions = static_cast<int>(section.integer("companions", opal.companions, 0, 7));
    section.finish();
    return opal;
}

SceneDescription read_document(const TomlDocument& document) {
    SceneDescription scene;
    TomlSection root = document.root();
    scene.render = read_render(root.section("render"));
    scene.camera = read_camera(root.section("camera"));
    scene.film = read_film(root.section("film"));
    scene.color = read_color(root.section("color"));
    scene.environment = read_environment(root.section("environment"));
    scene.opal = read_opal(root.section("opal"));
    std::vector<std::string> names;
    for (TomlSection& section : root.sections("material")) {
        scene.materials.push_back(read_material(section));
        if (std::find(names.begin(), names.end(), scene.materials.back().name) != names.end())
            section.fail("name", "'" + scene.materials.back().name + "' is already taken");
        names.push_back(scene.materials.back().name);
    }
    for (TomlSection& section : root.sections("object")) scene.objects.push_back(read_object(section, scene.materials));
    if (scene.objects.empty()) root.fail("object", "the scene is empty: at least one [[object]] is needed");
    for (TomlSection& section : root.sections("light")) scene.lights.push_back(read_light(section));
    scene.animation = read_animation(root.section("animation"));
    root.finish();
    return scene;
}

}  // namespace

SceneDescription read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    return read_document(TomlDocument(file, overrides));
}

SceneDescription parse_scene(const std::string& text, const std::string& name, const std::vector<std::string>& overrides) {
    return read_document(TomlDocument(text, name, overrides));
}

std::string scene_to_toml(const SceneDescription& scene) {
    const auto name = [](const std::vector<std::string>& names, auto value) { return names[static_cast<std::size_t>(value)]; };
    const RenderDescription& render = scene.render;
    const CameraDescription& camera = scene.camera;
    std::string text = fmt::format(
        "[render]\nwidth = {}\nheight = {}\nsamples = {}\nnoise = {}\nmax_bounces = {}\nseed = {}\nsampler = \"{}\"\nfilter = "
        "\"{}\"\n"
        "filter_radius_px = {}\n",
        render.width, render.height, render.samples, render.noise, render.max_bounces, render.seed,
        name(sampler_names, render.sampler), name(filter_names, render.filter), render.filter_radius_px);
    text += fmt::format("roulette = {}\nlight_sampling = \"{}\"\nguided = {}\n", render.roulette,
                        name(light_sampling_names, render.light_sampling), render.guided);
    if (render.crop)
        text += fmt::format("crop = [{}, {}, {}, {}]\n", render.crop->x0, render.crop->y0, render.crop->x1, render.crop->y1);
    text += fmt::format(
        "\n[camera]\nkind = \"{}\"\nposition_mm = {}\ntarget_mm = {}\nup = {}\nvertical_fov_deg = {}\nview_height_mm = {}\n"
        "aperture_radius_mm = {}\nfocus_mm = {}\n",
        name(camera_names, camera.kind), vector_text(camera.position_mm), vector_text(camera.target_mm), vector_text(camera.up),
        camera.vertical_fov_deg, camera.view_height_mm, camera.aperture_radius_mm, camera.focus_mm);
    text += "\n[film]\n" + film_to_toml(scene.film);
    text += fmt::format("\n[color]\nupsampling = \"{}\"\n", name(upsampling_names, scene.color.upsampling));
    text += fmt::format("\n[environment]\nkind = \"{}\"\n", name(environment_names, scene.environment.kind));
    if (!scene.environment.file.empty()) text += fmt::format("file = {}\n", toml_quoted(scene.environment.file.string()));
    text += fmt::format("radiance = {}\nrotate_deg = {}\nilluminant = \"{}\"\n", scene.environment.radiance,
                        scene.environment.rotate_deg, name(illuminant_names, scene.environment.illuminant));
    if (!scene.environment.illuminant_file.empty())
        text += fmt::format("illuminant_file = {}\n", toml_quoted(scene.environment.illuminant_file.string()));
    if (scene.environment.illuminant == IlluminantKind::blackbody || scene.environment.illuminant == IlluminantKind::led)
        text += fmt::format("temperature_k = {}\n", scene.environment.temperature_k);
    text += fmt::format(
        "\n[opal]\ndiffraction = \"{}\"\newald_tolerance = {}\nmax_odds = {}\ndispersion = \"{}\"\nmajorants = \"{}\"\n"
        "tracking = \"{}\"\ngrains = \"{}\"\ncompanions = {}\n",
        name(diffraction_names, scene.opal.diffraction), scene.opal.ewald_tolerance, scene.opal.max_odds,
        name(dispersion_names, scene.opal.dispersion), name(majorant_names, scene.opal.majorants),
        name(tracking_names, scene.opal.tracking), name(grains_names, scene.opal.grains), scene.opal.companions);
    for (const MaterialDescription& material : scene.materials) text += material_to_toml(material);
    for (const ObjectDescription& object : scene.objects) text += object_to_toml(object);
    for (const LightDescription& light : scene.lights) text += light_to_toml(light);
    return text + animation_to_toml(scene.animation);
}

}  // namespace opal
