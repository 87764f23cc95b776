// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/vec.h"

namespace opal {

/// A thin-lens or orthographic camera. `right` and `down` span the picture: at unit distance for a perspective view, in mm for an
/// orthographic one; both for the whole width and height.
struct Camera {
    Vec3 position;
    Vec3 forward;
    Vec3 right, down;
    real aperture_radius_mm = 0.0f;
    real focus_mm = 1.0f;  ///< along `forward`
    bool orthographic = false;
};

/// Ray through the picture position (x, y) in [0, 1]^2, top left first; (lens_u, lens_v) in [0, 1)^2 choose the point on the
/// lens. All rays of one picture position meet in the plane in focus.
OPAL_HD inline Ray camera_ray(const Camera& camera, real x, real y, real lens_u, real lens_v) {
    const Vec3 offset = (x - 0.5f) * camera.right + (y - 0.5f) * camera.down;
    const Vec3 origin = camera.orthographic ? camera.position + offset : camera.position;
    const Vec3 through = camera.orthographic ? camera.forward : camera.forward + offset;
    if (camera.aperture_radius_mm <= 0.0f) return {origin, camera.orthographic ? through : normalize(through)};
    const real radius_mm = camera.aperture_radius_mm * sqrt(lens_u), angle_rad = 2.0f * pi_f * lens_v;
    const Vec3 lens =
        (radius_mm * cos(angle_rad)) * normalize(camera.right) + (radius_mm * sin(angle_rad)) * normalize(camera.down);
    return {origin + lens, normalize(camera.focus_mm * through - lens)};
}

}  // namespace opal
