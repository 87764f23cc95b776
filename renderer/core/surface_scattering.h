// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/fresnel.h"
#include "renderer/core/scene_view.h"

namespace opal {

/// Continues a ray at the smooth surface of the opal: reflects with the Fresnel probability, else refracts, so that the
/// throughput stays 1. Where an interpolated normal would send the ray through the wrong side of the face, the face's own normal
/// is used. `u` is uniform in [0, 1). Returns the new unit direction.
OPAL_HD inline Vec3 scatter_dielectric(Vec3 direction, const Surface& surface, float n_eff, float u) {
    const bool entering = dot(direction, surface.geometric_normal) < 0.0f;
    const float eta = entering ? n_eff : 1.0f / n_eff;
    const Vec3 face = entering ? surface.geometric_normal : -surface.geometric_normal;
    Vec3 normal = entering ? surface.shading_normal : -surface.shading_normal;
    for (int attempt = 0; attempt < 2; ++attempt) {
        const float cos_incident = min_of(1.0f, -dot(direction, normal));
        if (cos_incident > 0.0f) {
            float cos_transmitted;
            const bool reflects = u < fresnel_dielectric(cos_incident, eta, cos_transmitted);
            const Vec3 result =
                reflects ? normalize(mirror(direction, normal)) : refract(direction, normal, eta, cos_incident, cos_transmitted);
            if ((dot(result, face) > 0.0f) == reflects) return result;
        }
        normal = face;
    }
    return normalize(mirror(direction, face));
}

/// Fresnel reflectance that scatter_dielectric uses for a ray that meets the surface from outside.
OPAL_HD inline float dielectric_reflectance(Vec3 direction, const Surface& surface, float n_eff) {
    const float cos_shading = -dot(direction, surface.shading_normal);
    const float cos_incident = min_of(1.0f, cos_shading > 0.0f ? cos_shading : -dot(direction, surface.geometric_normal));
    float cos_transmitted;
    return fresnel_dielectric(cos_incident, n_eff, cos_transmitted);
}

/// Cosine-distributed direction around a normal; density cos / pi.
OPAL_HD inline Vec3 sample_cosine(Vec3 normal, float u1, float u2) {
    const float radius = sqrtf(u1), angle_rad = 2.0f * pi_f * u2;
    const float height = sqrtf(max_of(0.0f, 1.0f - u1));
    return normalize(Frame(normal).world_from_local({radius * cosf(angle_rad), radius * sinf(angle_rad), height}));
}

}  // namespace opal
