// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/environment.h"
#include "renderer/core/light_shapes.h"

/// The lights of a scene beside its environment, and the choice among all of them.
namespace opal {

struct LightView {
    LightGeometry geometry;
    real cos_cone = -1.0f;            ///< spot: beyond this angle from the normal it is dark
    real cos_full = -1.0f;            ///< spot: within this one it shines fully
    const float* radiance = nullptr;  ///< 1 nm table: spectral radiance in the film's unit
    real luminance = 0.0f;            ///< of it
    bool visible = true;              ///< to the camera directly
};

struct LightsView {
    const LightView* lights = nullptr;
    int count = 0;
    real environment_luminance = 0.0f;  ///< mean over all directions
};

/// The part of a light's radiance that it sends along `direction` (unit, away from it): spots fade towards their cone's edge.
OPAL_HD inline real light_falloff(const LightView& light, Vec3 direction) {
    if (light.cos_cone <= -1.0f) return 1.0f;
    const real t = (dot(direction, light.geometry.normal) - light.cos_cone) / max_of(1.0e-7f, light.cos_full - light.cos_cone);
    const real clamped = max_of(0.0f, min_of(1.0f, t));
    return clamped * clamped * (3.0f - 2.0f * clamped);
}

/// Spectral radiance that a ray of `direction` finds where it meets the light.
OPAL_HD inline real light_radiance(const LightView& light, Vec3 direction, real wavelength_nm) {
    return light_falloff(light, -direction) * table_at(light.radiance, wavelength_nm);
}

struct LightHit {
    int light = -1;
    real distance_mm = 0.0f;
    bool shines = false;  ///< the side that does was met
};

/// The nearest light that a ray meets within `max_mm`. Lights stop rays from either side. `direct`: the ray comes straight from
/// the camera, which passes those that it is not to see.
OPAL_HD inline bool intersect_lights(const LightsView& view, const Ray& ray, real max_mm, bool direct, LightHit& hit) {
    hit = {-1, max_mm, false};
    for (int i = 0; i < view.count; ++i) {
        const LightView& light = view.lights[i];
        if (direct && !light.visible) continue;
        const real distance_mm = light_distance(light.geometry, ray);
        if (distance_mm > 0.0f && distance_mm < hit.distance_mm) hit = {i, distance_mm, light_faces(light.geometry, ray.origin)};
    }
    return hit.light >= 0;
}

/// Whether a light other than `target` stands in the way.
OPAL_HD inline bool lights_occlude(const LightsView& view, const Ray& ray, real max_mm, int target) {
    for (int i = 0; i < view.count; ++i) {
        if (i == target) continue;
        const real distance_mm = light_distance(view.lights[i].geometry, ray);
        if (distance_mm > 0.0f && distance_mm < max_mm) return true;
    }
    return false;
}

/// About how much light a point gets from a light when it faces it: luminance times solid angle.
OPAL_HD inline real light_importance(const LightView& light, Vec3 from) {
    const LightGeometry& geometry = light.geometry;
    if (!light_faces(geometry, from)) return 0.0f;
    switch (geometry.shape) {
        case LightShape::sun:
            return light.luminance * 2.0f * pi_f * geometry.sun_one_minus_cos;
        case LightShape::sphere:
            return light.luminance * 2.0f * pi_f * sphere_one_minus_cosine(geometry, from);
        default:
            break;
    }
    // A light seen edge-on from near by still fills much of the view.
    const Vec3 to = geometry.position - from;
    return light.luminance * min_of(2.0f * pi_f, light_area_mm2(geometry) / dot(to, to));
}

OPAL_HD inline real environment_importance(const LightsView& view) {
    return view.environment_luminance * 2.0f * pi_f;
}

OPAL_HD inline real total_importance(const LightsView& view, Vec3 from) {
    real sum = environment_importance(view);
    for (int i = 0; i < view.count; ++i) sum += light_importance(view.lights[i], from);
    return sum;
}

/// The index by which the environment is known among the lights.
inline constexpr int environment_light = -1;

/// Density (1/sr) with which sample_light draws `direction` for a light that it meets: the environment, or one of the lights.
OPAL_HD inline real light_pdf(const LightsView& view, const EnvironmentView& environment, Vec3 from, Vec3 direction, int light) {
    const real total = total_importance(view, from);
    if (!(total > 0.0f)) return 0.0f;
    if (light == environment_light)
        return environment_importance(view) > 0.0f
                   ? environment_importance(view) / total * environment_pdf(environment, direction)
                   : 0.0f;
    const LightView& chosen = view.lights[light];
    return light_importance(chosen, from) / total * light_direction_pdf(chosen.geometry, from, direction);
}

/// A direction towards one of the lights.
struct LightSample {
    Vec3 direction;
    real distance_mm = 3.0e38f;  ///< to it; infinite for the environment and the sun
    real pdf = 0.0f;             ///< 1/sr, with the probability that this light was chosen; 0: nothing drawn
    int light = environment_light;
};

/// Chooses the environment or a light by `u`, in proportion to about what they send to the point, and draws a direction to it.
OPAL_HD inline LightSample sample_light(const LightsView& view, const EnvironmentView& environment, Vec3 from, real u, real u1,
                                        real u2) {
    LightSample sample;
    const real total = total_importance(view, from);
    if (!(total > 0.0f)) return sample;
    real rest = u * total - environment_importance(view);
    if (rest >= 0.0f)
        for (int i = 0; i < view.count; ++i) {
            const real importance = light_importance(view.lights[i], from);
            if (importance > 0.0f) sample.light = i;  // rounding can carry `rest` past the last one
            if (rest < importance) break;
            rest -= importance;
        }
    if (sample.light == environment_light) {
        sample.direction = sample_environment(environment, u1, u2);
        sample.pdf = environment_importance(view) / total * environment_pdf(environment, sample.direction);
        return sample;
    }
    const LightView& light = view.lights[sample.light];
    const LightDirection drawn = sample_light_direction(light.geometry, from, u1, u2);
    sample.direction = drawn.direction;
    sample.distance_mm = drawn.distance_mm;
    sample.pdf = light_importance(light, from) / total * light_direction_pdf(light.geometry, from, drawn.direction);
    return sample;
}

}  // namespace opal
