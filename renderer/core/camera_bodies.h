// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/scene_view.h"

namespace opal {

/// The bodies that a camera ray starts in. Where the lens or the window of an orthographic picture cuts a body's surface, its
/// rays start partly inside: the nearest surface of such a body along the ray tells, which the ray leaves or enters.
template <class Intersector>
OPAL_HD inline NestedBodies bodies_at_start(const SceneView& scene, const Intersector& intersector, Ray ray) {
    NestedBodies inside = scene.camera_bodies;
    uint64_t unknown = scene.cut_bodies.inside;
    RayHit hit;
    while (unknown != 0 && intersector.closest(ray, hit)) {
        const Surface surface = surface_at(scene, hit);
        if (surface.body >= 0 && (unknown >> surface.body & 1u) != 0) {
            if (dot(ray.direction, surface.geometric_normal) > 0.0f) inside = inside.entered(surface.body);
            unknown &= ~(uint64_t(1) << surface.body);
        }
        ray.origin = offset_origin(surface.position, surface.geometric_normal, ray.direction);
    }
    return inside;
}

}  // namespace opal
