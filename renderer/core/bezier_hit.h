// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/bezier_patch.h"
#include "renderer/core/vec.h"

namespace opal {

/// A mesh that stands for Bezier patches: rays find its triangles, then the place on the patch itself.
struct PatchMeshView {
    const BezierPatch* patches = nullptr;         ///< world space; null where the triangles are the surface
    const uint32_t* patch_of_triangle = nullptr;  ///< index of the patch
    const float* parameters = nullptr;            ///< u, v per vertex
    float reach_mm = 0.0f;                        ///< a triangle's place and the patch's are no farther apart along a ray
    float slack_mm = 0.0f;                        ///< a ray that passes a patch's edge as near as this meets it
};

/// Where a ray meets a patch.
struct PatchHit {
    float u = 0.0f, v = 0.0f;
    float distance_mm = 0.0f;
    bool met = false;
};

/// Newton's method for S(u, v) on the ray, from a place nearby: the two components of S - origin across the ray vanish (Kajiya
/// 1982, "Ray tracing parametric patches", by planes through the ray). Not met: the ray misses the patch nearby, or meets it
/// where it starts: triangles lie a little before or behind the patch.
OPAL_HD inline PatchHit polish_patch_hit(const BezierPatch& patch, const Ray& ray, PatchHit start, float reach_mm,
                                         float slack_mm) {
    constexpr int most_steps = 12;
    constexpr double exact = 1.0e-9;
    using bezier_detail::dot;
    const double along[3] = {double(ray.direction.x), double(ray.direction.y), double(ray.direction.z)};
    const double origin[3] = {double(ray.origin.x), double(ray.origin.y), double(ray.origin.z)};
    const Frame frame(ray.direction);
    const double tangent[3] = {double(frame.tangent.x), double(frame.tangent.y), double(frame.tangent.z)};
    double across[2][3];  // in double, as a float's rounding shows at grazing incidence
    bezier_detail::cross(along, tangent, 1.0, across[0]);
    bezier_detail::cross(along, across[0], 1.0, across[1]);
    double u = double(start.u), v = double(start.v);
    for (int step = 0;; ++step) {
        const BezierPoint point = evaluate_bezier(patch, u, v);
        const double offset[3] = {point.position_mm[0] - origin[0], point.position_mm[1] - origin[1],
                                  point.position_mm[2] - origin[2]};
        const double f = dot(across[0], offset), g = dot(across[1], offset);
        const double residual_mm = sqrt(f * f + g * g), distance_mm = dot(along, offset) / dot(along, along);
        const double fu = dot(across[0], point.du_mm), fv = dot(across[0], point.dv_mm);
        const double gu = dot(across[1], point.du_mm), gv = dot(across[1], point.dv_mm);
        const double determinant = fu * gv - fv * gu;
        const bool found = residual_mm < exact * (1.0 + sqrt(dot(offset, offset)));
        if (found || step == most_steps || determinant == 0.0) {
            const bool ahead = distance_mm > double(1.0e-5f * (1.0f + max_abs(ray.origin)));
            const bool near_by = fabs(distance_mm - double(start.distance_mm)) <= double(reach_mm);
            return {float(u), float(v), float(distance_mm), ahead && near_by && residual_mm <= double(slack_mm)};
        }
        const double next_u = u - (f * gv - g * fv) / determinant, next_v = v - (g * fu - f * gu) / determinant;
        // Beyond the edge a neighbour goes on; here the nearest place on the edge is as good.
        u = next_u < 0.0 ? 0.0 : (next_u < 1.0 ? next_u : 1.0);
        v = next_v < 0.0 ? 0.0 : (next_v < 1.0 ? next_v : 1.0);
    }
}

/// A hit on a triangle (barycentric u, v of its second and third corner) as one on the patch that it stands for.
OPAL_HD inline PatchHit hit_on_patch(const PatchMeshView& mesh, const uint32_t* corner, const Ray& ray, uint32_t triangle,
                                     PatchHit hit) {
    const float w = 1.0f - hit.u - hit.v;
    float parameter[2];
    for (int axis = 0; axis < 2; ++axis)
        parameter[axis] = min_of(1.0f, max_of(0.0f, w * mesh.parameters[2 * size_t(corner[0]) + axis] +
                                                        hit.u * mesh.parameters[2 * size_t(corner[1]) + axis] +
                                                        hit.v * mesh.parameters[2 * size_t(corner[2]) + axis]));
    return polish_patch_hit(mesh.patches[mesh.patch_of_triangle[triangle]], ray,
                            {parameter[0], parameter[1], hit.distance_mm, true}, mesh.reach_mm, mesh.slack_mm);
}

}  // namespace opal
