// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/spherical_rectangle.h"
#include "renderer/core/vec.h"

/// The shapes of lights: where rays meet them, and directions towards them drawn per solid angle. Flat ones shine to the side of
/// their normal, a sphere outwards.
namespace opal {

enum class LightShape { rectangle, disk, sphere, sun };

struct LightGeometry {
    LightShape shape = LightShape::rectangle;
    Vec3 position;               ///< centre, mm
    Vec3 normal;                 ///< unit: the way that a flat light shines; the way that the sun's light travels
    Vec3 half_x, half_y;         ///< rectangle: from the centre to the middles of two edges, mm
    real radius_mm = 0.0f;       ///< disk, sphere
    real sun_one_minus_cos = 0;  ///< of the sun's angular radius
};

/// 1 - cos of the angle between unit vectors, without cancellation.
OPAL_HD inline real one_minus_cosine(Vec3 a, Vec3 b) {
    const Vec3 d = a - b;
    return 0.5f * dot(d, d);
}

/// Distance (mm) at which a ray meets the light, whichever side; negative where it does not. The sun is at no distance.
OPAL_HD inline real light_distance(const LightGeometry& light, const Ray& ray) {
    const Vec3 from = ray.origin - light.position;
    if (light.shape == LightShape::sphere) {
        // From the point nearest to the centre: no cancellation for far spheres.
        const real along = -dot(from, ray.direction);
        const Vec3 nearest = from + along * ray.direction;
        const real half2 = square(light.radius_mm) - dot(nearest, nearest);
        if (half2 < 0.0f) return -1.0f;
        const real half = sqrt(half2);
        return along > half ? along - half : (along + half > 0.0f ? along + half : -1.0f);
    }
    if (light.shape == LightShape::sun) return -1.0f;
    const real toward = dot(ray.direction, light.normal);
    if (toward == 0.0f) return -1.0f;
    const real distance = -dot(from, light.normal) / toward;
    if (!(distance > 0.0f)) return -1.0f;
    const Vec3 place = from + distance * ray.direction;
    if (light.shape == LightShape::disk) return dot(place, place) <= square(light.radius_mm) ? distance : -1.0f;
    const bool inside = fabs(dot(place, light.half_x)) <= dot(light.half_x, light.half_x) &&
                        fabs(dot(place, light.half_y)) <= dot(light.half_y, light.half_y);
    return inside ? distance : -1.0f;
}

/// Whether a ray from infinity along `direction`, reversed, comes from the sun's disc.
OPAL_HD inline bool in_sun(const LightGeometry& light, Vec3 direction) {
    return one_minus_cosine(direction, -light.normal) <= light.sun_one_minus_cos;
}

/// Whether a point sees the side that shines.
OPAL_HD inline bool light_faces(const LightGeometry& light, Vec3 from) {
    const Vec3 away = from - light.position;
    switch (light.shape) {
        case LightShape::sun:
            return true;
        case LightShape::sphere:
            return dot(away, away) > square(light.radius_mm);
        default:
            return dot(away, light.normal) > 0.0f;
    }
}

OPAL_HD inline real light_area_mm2(const LightGeometry& light) {
    if (light.shape == LightShape::rectangle) return 4.0f * length(light.half_x) * length(light.half_y);
    return pi_f * square(light.radius_mm);
}

/// 1 - cos of the angular radius under which a point outside sees a sphere.
OPAL_HD inline real sphere_one_minus_cosine(const LightGeometry& light, Vec3 from) {
    const Vec3 to = light.position - from;
    const real sine2 = min_of(1.0f, square(light.radius_mm) / dot(to, to));
    return sine2 / (1.0f + sqrt(1.0f - sine2));
}

OPAL_HD inline SphericalRectangle seen_rectangle(const LightGeometry& light, Vec3 from) {
    return {light.position, light.half_x, light.half_y, from};
}

/// Density (1/sr) with which sample_light_direction draws a direction that meets the light's shining side.
OPAL_HD inline real light_direction_pdf(const LightGeometry& light, Vec3 from, Vec3 direction) {
    if (light.shape == LightShape::sun) return 1.0f / (2.0f * pi_f * light.sun_one_minus_cos);
    if (!light_faces(light, from)) return 0.0f;
    if (light.shape == LightShape::sphere) return 1.0f / (2.0f * pi_f * sphere_one_minus_cosine(light, from));
    if (light.shape == LightShape::rectangle) {
        const SphericalRectangle seen = seen_rectangle(light, from);
        if (seen.worth_drawing()) return real(1.0 / seen.solid_angle());
    }
    const real distance = light_distance(light, {from, direction});
    const real cosine = -dot(direction, light.normal);
    return distance > 0.0f && cosine > 0.0f ? distance * distance / (light_area_mm2(light) * cosine) : 0.0f;
}

/// Direction at the angle given by 1 - cos from an axis.
OPAL_HD inline Vec3 cone_direction(Vec3 axis, real one_minus_cos, real u) {
    const real sine = sqrt(max_of(0.0f, one_minus_cos * (2.0f - one_minus_cos))), angle_rad = 2.0f * pi_f * u;
    return normalize(Frame(axis).world_from_local({sine * cos(angle_rad), sine * sin(angle_rad), 1.0f - one_minus_cos}));
}

/// A drawn direction towards a light and the distance (mm) to it; infinite for the sun.
struct LightDirection {
    Vec3 direction;
    real distance_mm = 3.0e38f;
};

/// Draws a direction from a point that sees the light's shining side.
OPAL_HD inline LightDirection sample_light_direction(const LightGeometry& light, Vec3 from, real u1, real u2) {
    if (light.shape == LightShape::sun) return {cone_direction(-light.normal, u1 * light.sun_one_minus_cos, u2)};
    if (light.shape == LightShape::sphere) {
        const Vec3 to = light.position - from;
        const real one_minus_cos = u1 * sphere_one_minus_cosine(light, from);
        const Vec3 direction = cone_direction(normalize(to), one_minus_cos, u2);
        const real sine2 = one_minus_cos * (2.0f - one_minus_cos), distance2 = dot(to, to);
        const real half2 = max_of(0.0f, square(light.radius_mm) - distance2 * sine2);
        return {direction, sqrt(distance2) * (1.0f - one_minus_cos) - sqrt(half2)};
    }
    Vec3 place = light.position;
    if (light.shape == LightShape::rectangle) {
        const SphericalRectangle seen = seen_rectangle(light, from);
        if (seen.worth_drawing()) {
            LightDirection drawn;
            drawn.direction = seen.direction(u1, u2, drawn.distance_mm);
            return drawn;
        }
        place = place + (2.0f * u1 - 1.0f) * light.half_x + (2.0f * u2 - 1.0f) * light.half_y;
    } else {
        const Frame frame(light.normal);
        const real radius_mm = light.radius_mm * sqrt(u1), angle_rad = 2.0f * pi_f * u2;
        place = place + frame.world_from_local({radius_mm * cos(angle_rad), radius_mm * sin(angle_rad), 0.0f});
    }
    const Vec3 to = place - from;
    const real distance_mm = length(to);
    return {(1.0f / distance_mm) * to, distance_mm};
}

}  // namespace opal
