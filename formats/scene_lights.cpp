// SPDX-License-Identifier: Apache-2.0
#include "formats/scene_lights.h"

#include <fmt/format.h>

#include <cmath>

#include "formats/illuminant.h"
#include "formats/text.h"
#include "formats/toml_enum.h"

namespace opal {
namespace {

const std::vector<std::string> light_names = {"area", "sphere", "spot", "sun"};
const std::vector<std::string> illuminant_names = {"D65", "A", "E", "blackbody", "led", "file"};

bool parallel(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        if (a[j] * b[k] - a[k] * b[j] != 0.0) return false;
    }
    return true;
}

/// Where a light that shines one way stands and where it looks.
void read_aim(TomlSection& section, LightDescription& light) {
    light.target_mm = section.vector3("target_mm", light.target_mm, NumberRange::between(-1.0e7, 1.0e7));
    if (light.target_mm == light.position_mm) section.fail("target_mm", "is where the light stands");
}

void read_area(TomlSection& section, LightDescription& light) {
    const NumberRange length = NumberRange::positive(1.0e6);
    read_aim(section, light);
    light.disk = section.has("radius_mm");
    if (light.disk) {
        for (const char* key : {"width_mm", "height_mm", "up"})
            if (section.has(key)) section.fail(key, "is for a rectangle; with radius_mm the light is a disk");
        light.radius_mm = section.number("radius_mm", light.radius_mm, length);
        return;
    }
    light.width_mm = section.number("width_mm", light.width_mm, length);
    light.height_mm = section.number("height_mm", light.height_mm, length);
    std::array<double, 3> aim;
    for (std::size_t i = 0; i < 3; ++i) aim[i] = light.target_mm[i] - light.position_mm[i];
    const bool upright = aim[0] == 0.0 && aim[1] == 0.0;
    light.up =
        section.vector3("up", upright ? std::array<double, 3>{0.0, 1.0, 0.0} : light.up, NumberRange::between(-1.0e7, 1.0e7));
    if (parallel(aim, light.up)) section.fail("up", "must not point along the light's direction");
}

void read_illuminant(TomlSection& section, LightDescription& light) {
    light.illuminant_file = section.path("illuminant_file");
    light.illuminant = enum_choice(section, "illuminant",
                                   light.illuminant_file.empty() ? IlluminantKind::d65 : IlluminantKind::file, illuminant_names);
    if ((light.illuminant == IlluminantKind::file) != !light.illuminant_file.empty())
        section.fail("illuminant_file", "and illuminant = \"file\" go together: a .csv with wavelength_nm and a relative power");
    if (light.illuminant == IlluminantKind::blackbody)
        light.temperature_k = section.number("temperature_k", light.temperature_k, NumberRange::between(1000.0, 25000.0));
    if (light.illuminant == IlluminantKind::led)
        light.temperature_k = section.number("temperature_k", light.temperature_k, NumberRange::between(led_min_k, led_max_k));
}

}  // namespace

LightDescription read_light(TomlSection section) {
    LightDescription light;
    if (!section.has("kind")) section.fail("kind", "is needed; allowed: " + join(light_names));
    light.kind = enum_choice(section, "kind", light.kind, light_names);
    if (light.kind == LightKind::sun) {
        light.elevation_deg = section.number("elevation_deg", light.elevation_deg, NumberRange::between(-90.0, 90.0));
        light.azimuth_deg = section.number("azimuth_deg", light.azimuth_deg, NumberRange::between(-3.6e4, 3.6e4));
        light.angular_diameter_deg =
            section.number("angular_diameter_deg", light.angular_diameter_deg, NumberRange::between(1.0e-3, 90.0));
        light.irradiance = section.number("irradiance", light.irradiance, NumberRange::from_zero(1.0e9));
    } else {
        light.position_mm = section.vector3("position_mm", light.position_mm, NumberRange::between(-1.0e7, 1.0e7));
        light.radiance = section.number("radiance", light.radiance, NumberRange::from_zero(1.0e12));
    }
    if (light.kind == LightKind::area) read_area(section, light);
    if (light.kind == LightKind::sphere)
        light.radius_mm = section.number("radius_mm", light.radius_mm, NumberRange::positive(1.0e6));
    if (light.kind == LightKind::spot) {
        read_aim(section, light);
        light.radius_mm = section.number("radius_mm", light.radius_mm, NumberRange::positive(1.0e6));
        light.cone_deg = section.number("cone_deg", light.cone_deg, NumberRange{0.0, 180.0, true});
        light.blend = section.number("blend", light.blend, NumberRange::between(0.0, 1.0));
    }
    light.color = section.vector3("color", light.color, NumberRange::from_zero(1.0), true);
    read_illuminant(section, light);
    light.visible = section.boolean("visible", light.visible);
    section.finish();
    return light;
}

std::string light_to_toml(const LightDescription& light) {
    std::string text = fmt::format("\n[[light]]\nkind = \"{}\"\n", light_names[static_cast<std::size_t>(light.kind)]);
    if (light.kind == LightKind::sun)
        text += fmt::format("elevation_deg = {}\nazimuth_deg = {}\nangular_diameter_deg = {}\nirradiance = {}\n",
                            light.elevation_deg, light.azimuth_deg, light.angular_diameter_deg, light.irradiance);
    else
        text += fmt::format("position_mm = {}\nradiance = {}\n", vector_text(light.position_mm), light.radiance);
    const bool rectangle = light.kind == LightKind::area && !light.disk;
    if (light.kind == LightKind::area || light.kind == LightKind::spot)
        text += fmt::format("target_mm = {}\n", vector_text(light.target_mm));
    if (rectangle)
        text += fmt::format("up = {}\nwidth_mm = {}\nheight_mm = {}\n", vector_text(light.up), light.width_mm, light.height_mm);
    else if (light.kind != LightKind::sun)
        text += fmt::format("radius_mm = {}\n", light.radius_mm);
    if (light.kind == LightKind::spot) text += fmt::format("cone_deg = {}\nblend = {}\n", light.cone_deg, light.blend);
    text += fmt::format("color = {}\nilluminant = \"{}\"\n", vector_text(light.color),
                        illuminant_names[static_cast<std::size_t>(light.illuminant)]);
    if (!light.illuminant_file.empty())
        text += fmt::format("illuminant_file = {}\n", toml_quoted(light.illuminant_file.string()));
    if (light.illuminant == IlluminantKind::blackbody || light.illuminant == IlluminantKind::led)
        text += fmt::format("temperature_k = {}\n", light.temperature_k);
    return text + fmt::format("visible = {}\n", light.visible);
}

}  // namespace opal
