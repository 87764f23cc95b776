// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/camera.h"
#include "renderer/core/crystal.h"
#include "renderer/core/environment.h"
#include "renderer/core/grain_walk.h"
#include "renderer/core/spectrum_view.h"

/// Everything the transport reads: pointers and counts, the one thing that crosses to a device.
namespace opal {

/// A triangle mesh in world space.
struct MeshView {
    const Vec3* positions = nullptr;
    const Vec3* normals = nullptr;  ///< per vertex, outward; null where the faces are flat
    const uint32_t* indices = nullptr;
    int material = -1;  ///< index of a diffuse material; -1 for the opal's surface
};

struct DiffuseMaterial {
    UpsampledColor albedo;
};

/// The opal of the scene.
struct OpalView {
    bool present = false;
    bool diffraction = true;
    RigidTransform world_from_object;
    GrainField grains;
    const Quaternion* orientations = nullptr;  ///< lattice -> object; element g - 1 is grain g's
    float n_eff = 1.0f;
    PlanePair pairs[max_tested_pairs];
    int num_pairs = 0;
    float coherence_nm = 25000.0f;          ///< mean thickness of a coherent block
    const float* sigma_a_per_mm = nullptr;  ///< 1 nm table
    float sigma_s_rayleigh_400nm_per_mm = 0.0f;
    float sigma_s_mie_per_mm = 0.0f;
    float mie_asymmetry = 0.0f;
};

struct SceneView {
    Camera camera;
    SpectrumTables spectra;
    EnvironmentView environment;
    OpalView opal;
    const MeshView* meshes = nullptr;
    const DiffuseMaterial* materials = nullptr;
    int width = 0, height = 0;
    int max_bounces = 64;
    int wavelengths = num_lanes;  ///< 1 + companions
    uint64_t seed = 1;
    bool stratified = true;
    bool tent_filter = true;
};

/// What a ray met.
struct RayHit {
    float distance_mm = 0.0f;
    uint32_t mesh = 0;
    uint32_t triangle = 0;
    float u = 0.0f, v = 0.0f;
};

/// Geometry at a hit: normals are outward and unit length.
struct Surface {
    Vec3 position;
    Vec3 geometric_normal;
    Vec3 shading_normal;
    int material;
};

OPAL_HD inline Surface surface_at(const SceneView& scene, const RayHit& hit) {
    const MeshView& mesh = scene.meshes[hit.mesh];
    const uint32_t* corner = mesh.indices + 3 * size_t(hit.triangle);
    const Vec3 a = mesh.positions[corner[0]], b = mesh.positions[corner[1]], c = mesh.positions[corner[2]];
    const float w = 1.0f - hit.u - hit.v;
    Surface surface;
    surface.position = w * a + hit.u * b + hit.v * c;
    surface.geometric_normal = normalize(cross(b - a, c - a));
    surface.shading_normal = surface.geometric_normal;
    if (mesh.normals)
        surface.shading_normal =
            normalize(w * mesh.normals[corner[0]] + hit.u * mesh.normals[corner[1]] + hit.v * mesh.normals[corner[2]]);
    surface.material = mesh.material;
    return surface;
}

/// A point moved off its surface, towards the side `direction` leaves to, by a little more than its rounding error.
OPAL_HD inline Vec3 offset_origin(Vec3 position, Vec3 geometric_normal, Vec3 direction) {
    const float distance = 4.0e-6f * (1.0f + max_abs(position));
    return position + (dot(direction, geometric_normal) >= 0.0f ? distance : -distance) * geometric_normal;
}

}  // namespace opal
