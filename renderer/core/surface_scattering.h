// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/fresnel.h"
#include "renderer/core/scene_view.h"

namespace opal {

/// Both ways on from a smooth surface, and the Fresnel reflectance between them for every lane.
template <int N>
struct DielectricSplit {
    Vec3 reflected, refracted;  ///< unit; refracted for the hero, zero under total reflection
    real reflectance[N];
};

/// How light of unit `direction` leaves a smooth surface, with the lanes' indices before and beyond it. Where an interpolated
/// normal would send a ray through the wrong side of the face, the face's own normal is used.
template <int N>
OPAL_HD inline DielectricSplit<N> split_dielectric(Vec3 direction, const Surface& surface, const real* index_before,
                                                   const real* index_beyond) {
    const bool entering = dot(direction, surface.geometric_normal) < 0.0f;
    const Vec3 face = entering ? surface.geometric_normal : -surface.geometric_normal;
    const Vec3 shading = entering ? surface.shading_normal : -surface.shading_normal;
    DielectricSplit<N> split;
    for (const bool last : {false, true}) {
        const Vec3 normal = last ? face : shading;
        const real cos_incident = max_of(1.0e-7f, min_of(1.0f, -dot(direction, normal)));
        real cos_transmitted = 0.0f;
        for (int i = N - 1; i >= 0; --i)
            split.reflectance[i] = fresnel_dielectric(cos_incident, index_beyond[i] / index_before[i], cos_transmitted);
        const bool passes = cos_transmitted > 0.0f;
        split.reflected = normalize(mirror(direction, normal));
        split.refracted = {};
        if (passes)
            split.refracted = refract(direction, normal, index_beyond[0] / index_before[0], cos_incident, cos_transmitted);
        if (dot(direction, normal) < 0.0f && dot(split.reflected, face) > 0.0f && (!passes || dot(split.refracted, face) < 0.0f))
            break;
    }
    return split;
}

/// Cosine-distributed direction around a normal; density cos / pi.
OPAL_HD inline Vec3 sample_cosine(Vec3 normal, real u1, real u2) {
    const real radius = sqrt(u1), angle_rad = 2.0f * pi_f * u2;
    const real height = sqrt(max_of(0.0f, 1.0f - u1));
    return normalize(Frame(normal).world_from_local({radius * cos(angle_rad), radius * sin(angle_rad), height}));
}

}  // namespace opal
