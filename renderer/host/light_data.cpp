// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/light_data.h"

#include <cmath>

#include "formats/illuminant.h"
#include "formats/units.h"
#include "renderer/host/spectrum_tables.h"
#include "renderer/host/upsampler.h"

namespace opal {
namespace {

Vec3 to_vec3(const std::array<double, 3>& v) {
    return {float(v[0]), float(v[1]), float(v[2])};
}

LightGeometry flat_light(const LightDescription& description) {
    LightGeometry light;
    light.shape = LightShape::disk;
    light.position = to_vec3(description.position_mm);
    light.normal = normalize(to_vec3(description.target_mm) - light.position);
    light.radius_mm = float(description.radius_mm);
    if (description.kind == LightKind::spot || description.disk) return light;
    light.shape = LightShape::rectangle;
    const Vec3 across = normalize(cross(light.normal, to_vec3(description.up)));
    light.half_x = float(0.5 * description.width_mm) * across;
    light.half_y = float(0.5 * description.height_mm) * cross(across, light.normal);
    return light;
}

LightGeometry geometry_of(const LightDescription& description) {
    LightGeometry light;
    switch (description.kind) {
        case LightKind::sphere:
            light.shape = LightShape::sphere;
            light.position = to_vec3(description.position_mm);
            light.radius_mm = float(description.radius_mm);
            return light;
        case LightKind::sun: {
            const double elevation = units::rad_from_deg(description.elevation_deg);
            const double azimuth = units::rad_from_deg(description.azimuth_deg);
            light.shape = LightShape::sun;
            light.normal = normalize(-Vec3{float(std::cos(elevation) * std::cos(azimuth)),
                                           float(std::cos(elevation) * std::sin(azimuth)), float(std::sin(elevation))});
            const double half_sine = std::sin(0.25 * units::rad_from_deg(description.angular_diameter_deg));
            light.sun_one_minus_cos = float(2.0 * half_sine * half_sine);
            return light;
        }
        default:
            return flat_light(description);
    }
}

/// Radiance of the light's white, in the film's unit.
double radiance_scale(const LightDescription& description) {
    if (description.kind != LightKind::sun) return description.radiance;
    const double sine = std::sin(0.5 * units::rad_from_deg(description.angular_diameter_deg));
    return description.irradiance / (units::pi * sine * sine);
}

}  // namespace

LightData::LightData(const std::vector<LightDescription>& descriptions, Upsampling upsampling, float environment_luminance)
    : environment_luminance_(environment_luminance) {
    if (descriptions.empty()) return;
    SpectrumTableOptions options;
    options.upsampling = upsampling;
    const SpectrumTablesData tables = make_spectrum_tables(options);
    for (const LightDescription& description : descriptions) {
        const UpsampledColor color = upsample_reflectance(
            tables.upsampling, {float(description.color[0]), float(description.color[1]), float(description.color[2])});
        const std::vector<double> white = colorimetric_table(
            illuminant_spectrum(description.illuminant, description.temperature_k, description.illuminant_file));
        std::vector<float> radiance;
        double luminance = 0.0;
        for (int i = 0; i < spectrum_samples; ++i) {
            radiance.push_back(float(radiance_scale(description) * white[std::size_t(i)] *
                                     double(upsampled(tables.view(), color, spectrum_min_nm + float(i)))));
            luminance += double(radiance.back()) * double(tables.observer[std::size_t(i)].y);
        }
        radiance_.push_back(std::move(radiance));
        LightView light;
        light.geometry = geometry_of(description);
        if (description.kind == LightKind::spot) {
            const double half = 0.5 * units::rad_from_deg(description.cone_deg);
            light.cos_cone = float(std::cos(half));
            light.cos_full = float(std::cos(half * (1.0 - description.blend)));
        }
        light.radiance = radiance_.back().data();
        light.luminance = float(luminance);
        light.visible = description.visible;
        lights_.push_back(light);
    }
}

LightsView LightData::view() const {
    return {lights_.data(), int(lights_.size()), environment_luminance_};
}

std::vector<double> LightData::spectrum_at(Vec3 point) const {
    std::vector<double> sum(spectrum_samples, 0.0);
    for (const LightView& light : lights_) {
        if (!(light.luminance > 0.0f)) continue;
        const double share = double(light_importance(light, point)) / double(light.luminance);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += share * double(light.radiance[i]);
    }
    return sum;
}

}  // namespace opal
