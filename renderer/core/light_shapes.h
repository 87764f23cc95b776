// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/vec.h"

/// The shapes of lights: where rays meet them, and directions towards them drawn per solid angle. Flat ones shine to the side of
/// their normal, a sphere outwards.
namespace opal {

enum class LightShape { rectangle, disk, sphere, sun };

struct LightGeometry {
    LightShape shape = LightShape::rectangle;
    Vec3 position;                ///< centre, mm
    Vec3 normal;                  ///< unit: the way that a flat light shines; the way that the sun's light travels
    Vec3 half_x, half_y;          ///< rectangle: from the centre to the middles of two edges, mm
    float radius_mm = 0.0f;       ///< disk, sphere
    float sun_one_minus_cos = 0;  ///< of the sun's angular radius
};

/// 1 - cos of the angle between unit vectors, without cancellation.
OPAL_HD inline float one_minus_cosine(Vec3 a, Vec3 b) {
    const Vec3 d = a - b;
    return 0.5f * dot(d, d);
}

/// Distance (mm) at which a ray meets the light, whichever side; negative where it does not. The sun is at no distance.
OPAL_HD inline float light_distance(const LightGeometry& light, const Ray& ray) {
    const Vec3 from = ray.origin - light.position;
    if (light.shape == LightShape::sphere) {
        // From the point nearest to the centre: no cancellation for far spheres.
        const float along = -dot(from, ray.direction);
        const Vec3 nearest = from + along * ray.direction;
        const float half2 = square(light.radius_mm) - dot(nearest, nearest);
        if (half2 < 0.0f) return -1.0f;
        const float half = sqrtf(half2);
        return along > half ? along - half : (along + half > 0.0f ? along + half : -1.0f);
    }
    if (light.shape == LightShape::sun) return -1.0f;
    const float toward = dot(ray.direction, light.normal);
    if (toward == 0.0f) return -1.0f;
    const float distance = -dot(from, light.normal) / toward;
    if (!(distance > 0.0f)) return -1.0f;
    const Vec3 place = from + distance * ray.direction;
    if (light.shape == LightShape::disk) return dot(place, place) <= square(light.radius_mm) ? distance : -1.0f;
    const bool inside = fabsf(dot(place, light.half_x)) <= dot(light.half_x, light.half_x) &&
                        fabsf(dot(place, light.half_y)) <= dot(light.half_y, light.half_y);
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

OPAL_HD inline float light_area_mm2(const LightGeometry& light) {
    if (light.shape == LightShape::rectangle) return 4.0f * length(light.half_x) * length(light.half_y);
    return pi_f * square(light.radius_mm);
}

/// 1 - cos of the angular radius under which a point outside sees a sphere.
OPAL_HD inline float sphere_one_minus_cosine(const LightGeometry& light, Vec3 from) {
    const Vec3 to = light.position - from;
    const float sine2 = min_of(1.0f, square(light.radius_mm) / dot(to, to));
    return sine2 / (1.0f + sqrtf(1.0f - sine2));
}

/// A rectangle as a point sees it, for drawing directions evenly within its solid angle (Urena, Fajardo & King 2013, "An
/// area-preserving parametrization for spherical rectangles").
struct SphericalRectangle {
    Vec3 x, y, z;              ///< frame: along the edges, away from the rectangle
    float x0, x1, y0, y1, z0;  ///< the rectangle in it, z0 < 0
    float b0, b1, k;
    float solid_angle;

    OPAL_HD SphericalRectangle(const LightGeometry& light, Vec3 from) {
        const float half_width = length(light.half_x), half_height = length(light.half_y);
        x = (1.0f / half_width) * light.half_x;
        y = (1.0f / half_height) * light.half_y;
        z = cross(x, y);
        const Vec3 to = light.position - from;
        z0 = dot(to, z);
        if (z0 > 0.0f) {
            z = -z;
            z0 = -z0;
        }
        const float centre_x = dot(to, x), centre_y = dot(to, y);
        x0 = centre_x - half_width;
        x1 = centre_x + half_width;
        y0 = centre_y - half_height;
        y1 = centre_y + half_height;
        // Normals of the four planes through the point and an edge: (0, z0, -y0), (-z0, 0, x1), (0, -z0, y1), (z0, 0, -x0).
        const float n0 = -y0 / sqrtf(z0 * z0 + y0 * y0), n1 = x1 / sqrtf(z0 * z0 + x1 * x1);
        const float n2 = y1 / sqrtf(z0 * z0 + y1 * y1), n3 = -x0 / sqrtf(z0 * z0 + x0 * x0);
        const float g0 = acosf(-n0 * n1), g1 = acosf(-n1 * n2), g2 = acosf(-n2 * n3), g3 = acosf(-n3 * n0);
        b0 = n0;
        b1 = n2;
        k = 2.0f * pi_f - g2 - g3;
        solid_angle = g0 + g1 - k;
    }

    /// Unit direction for two uniform numbers.
    OPAL_HD Vec3 direction(float u, float v) const {
        const float au = u * solid_angle + k;
        const float fu = (cosf(au) * b0 - b1) / sinf(au);
        float cu = copysignf(1.0f, fu) / sqrtf(fu * fu + b0 * b0);
        cu = max_of(-0.9999999f, min_of(0.9999999f, cu));
        const float xu = max_of(x0, min_of(x1, -(cu * z0) / sqrtf(1.0f - cu * cu)));
        const float d2 = xu * xu + z0 * z0;
        const float h0 = y0 / sqrtf(d2 + y0 * y0), h1 = y1 / sqrtf(d2 + y1 * y1);
        const float hv = h0 + v * (h1 - h0), hv2 = hv * hv;
        const float yv = hv2 < 0.9999999f ? max_of(y0, min_of(y1, hv * sqrtf(d2) / sqrtf(1.0f - hv2))) : y1;
        return normalize(xu * x + yv * y + z0 * z);
    }
};

/// Solid angle (sr), by area and distance, below which a flat light's directions are drawn evenly over its area: the spherical
/// rectangle loses digits there, and the area is nearly as good.
inline constexpr float small_solid_angle_sr = 0.01f;

OPAL_HD inline float crude_solid_angle_sr(const LightGeometry& light, Vec3 from) {
    const Vec3 to = light.position - from;
    const float distance2 = dot(to, to);
    return light_area_mm2(light) / distance2 * max_of(0.0f, -dot(to, light.normal)) / sqrtf(distance2);
}

OPAL_HD inline bool drawn_by_solid_angle(const LightGeometry& light, Vec3 from) {
    return light.shape == LightShape::rectangle && crude_solid_angle_sr(light, from) > small_solid_angle_sr;
}

/// Density (1/sr) with which sample_light_direction draws a direction that meets the light's shining side.
OPAL_HD inline float light_direction_pdf(const LightGeometry& light, Vec3 from, Vec3 direction) {
    if (light.shape == LightShape::sun) return 1.0f / (2.0f * pi_f * light.sun_one_minus_cos);
    if (!light_faces(light, from)) return 0.0f;
    if (light.shape == LightShape::sphere) return 1.0f / (2.0f * pi_f * sphere_one_minus_cosine(light, from));
    if (drawn_by_solid_angle(light, from)) return 1.0f / SphericalRectangle(light, from).solid_angle;
    const float distance = light_distance(light, {from, direction});
    const float cosine = -dot(direction, light.normal);
    return distance > 0.0f && cosine > 0.0f ? distance * distance / (light_area_mm2(light) * cosine) : 0.0f;
}

/// Direction at the angle given by 1 - cos from an axis.
OPAL_HD inline Vec3 cone_direction(Vec3 axis, float one_minus_cos, float u) {
    const float sine = sqrtf(max_of(0.0f, one_minus_cos * (2.0f - one_minus_cos))), angle_rad = 2.0f * pi_f * u;
    return normalize(Frame(axis).world_from_local({sine * cosf(angle_rad), sine * sinf(angle_rad), 1.0f - one_minus_cos}));
}

/// A drawn direction towards a light and the distance (mm) to it; infinite for the sun.
struct LightDirection {
    Vec3 direction;
    float distance_mm = 3.0e38f;
};

/// Draws a direction from a point that sees the light's shining side.
OPAL_HD inline LightDirection sample_light_direction(const LightGeometry& light, Vec3 from, float u1, float u2) {
    if (light.shape == LightShape::sun) return {cone_direction(-light.normal, u1 * light.sun_one_minus_cos, u2)};
    if (light.shape == LightShape::sphere) {
        const Vec3 to = light.position - from;
        const float one_minus_cos = u1 * sphere_one_minus_cosine(light, from);
        const Vec3 direction = cone_direction(normalize(to), one_minus_cos, u2);
        const float sine2 = one_minus_cos * (2.0f - one_minus_cos), distance2 = dot(to, to);
        const float half2 = max_of(0.0f, square(light.radius_mm) - distance2 * sine2);
        return {direction, sqrtf(distance2) * (1.0f - one_minus_cos) - sqrtf(half2)};
    }
    if (drawn_by_solid_angle(light, from)) {
        const Vec3 direction = SphericalRectangle(light, from).direction(u1, u2);
        return {direction, dot(light.position - from, light.normal) / dot(direction, light.normal)};
    }
    Vec3 place = light.position;
    if (light.shape == LightShape::rectangle) {
        place = place + (2.0f * u1 - 1.0f) * light.half_x + (2.0f * u2 - 1.0f) * light.half_y;
    } else {
        const Frame frame(light.normal);
        const float radius_mm = light.radius_mm * sqrtf(u1), angle_rad = 2.0f * pi_f * u2;
        place = place + frame.world_from_local({radius_mm * cosf(angle_rad), radius_mm * sinf(angle_rad), 0.0f});
    }
    const Vec3 to = place - from;
    const float distance_mm = length(to);
    return {(1.0f / distance_mm) * to, distance_mm};
}

}  // namespace opal
