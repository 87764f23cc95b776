// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/vec.h"

namespace opal {

/// Unpolarized Fresnel reflectance of a smooth interface between two dielectrics (Born & Wolf, section 1.5.2), and the cosine of
/// the refracted direction. `cos_incident` >= 0; `eta` = index beyond the interface / index before it. Returns 1 with
/// `cos_transmitted` = 0 under total internal reflection.
OPAL_HD inline real fresnel_dielectric(real cos_incident, real eta, real& cos_transmitted) {
    const real sin2_transmitted = (1.0f - cos_incident * cos_incident) / (eta * eta);
    if (sin2_transmitted >= 1.0f) {
        cos_transmitted = 0.0f;
        return 1.0f;
    }
    cos_transmitted = sqrt(1.0f - sin2_transmitted);
    const real s = (cos_incident - eta * cos_transmitted) / (cos_incident + eta * cos_transmitted);
    const real p = (eta * cos_incident - cos_transmitted) / (eta * cos_incident + cos_transmitted);
    return 0.5f * (s * s + p * p);
}

/// Refracted direction for unit `direction` meeting the unit `normal` that faces it (dot < 0).
OPAL_HD inline Vec3 refract(Vec3 direction, Vec3 normal, real eta, real cos_incident, real cos_transmitted) {
    return normalize((1.0f / eta) * direction + (cos_incident / eta - cos_transmitted) * normal);
}

}  // namespace opal
