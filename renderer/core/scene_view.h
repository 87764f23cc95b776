// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/bezier_hit.h"
#include "renderer/core/camera.h"
#include "renderer/core/crystal.h"
#include "renderer/core/environment.h"
#include "renderer/core/field_lookup.h"
#include "renderer/core/grain_path.h"
#include "renderer/core/light_guide.h"
#include "renderer/core/lights.h"
#include "renderer/core/material.h"
#include "renderer/core/medium.h"
#include "renderer/core/nested_bodies.h"
#include "renderer/core/path_random.h"
#include "renderer/core/pixel_filter.h"
#include "renderer/core/two_beam.h"

/// Everything the transport reads: pointers and counts, the one thing that crosses to a device.
namespace opal {

/// A triangle mesh in world space.
struct MeshView {
    const Vec3* positions = nullptr;
    const Vec3* normals = nullptr;  ///< per vertex, outward; null where the faces are flat
    const uint32_t* indices = nullptr;
    uint32_t num_vertices = 0, num_triangles = 0;
    int material = -1;      ///< of an opaque surface; -1 where it bounds a body
    int body = -1;          ///< that the surface bounds; -1 where it is opaque
    PatchMeshView patches;  ///< of an exact surface
};

/// How lattice planes turn light.
enum class Diffraction { none, two_beam, ewald_fresnel, laue };

/// A transparent body: an opal, or glass (without diffraction).
struct OpalView {
    int object = 0;  ///< bodies of one object (the parts of an exact surface) are one: there is nothing between them
    Diffraction diffraction = Diffraction::two_beam;
    RigidTransform world_from_object;
    GrainsView grains;
    FieldView shape;                           ///< level set of the surface, object mm; its grid may be absent
    const Quaternion* orientations = nullptr;  ///< lattice -> object; element g - 1 is grain g's
    const float* grain_size_mm = nullptr;      ///< object mm; element g - 1: diameter of a ball as large as grain g
    int num_grains = 0;
    const float* n_eff = nullptr;           ///< 1 nm table: effective index where light diffracts
    const float* contrast = nullptr;        ///< 1 nm table: |n_sphere^2 - n_medium^2|
    const float* relative_index = nullptr;  ///< 1 nm table: n_sphere / n_medium
    const float* surface_index = nullptr;   ///< 1 nm table: effective index where light refracts
    bool surface_disperses = false;         ///< surface_index varies
    real roughness = 0.0f;                  ///< of the surface, GGX alpha; below min_roughness: smooth
    PlanePair pairs[max_tested_pairs];
    PlaneFamilies families;  ///< of the pairs
    int num_pairs = 0;
    real coherence_nm = 25000.0f;  ///< mean thickness of a coherent block
    real fault = 0.0f;             ///< probability of a stacking fault per layer
    real layer_nm = 204.0f;        ///< distance of stacked layers
    real mosaic_kappa = 0.0f;      ///< 0: no mosaic spread
    real max_odds = 400.0f;        ///< where the odds of reflection over a grain's size saturate
    real ewald_tolerance = 0.01f;
    MediumView medium;
    LightGuideView guide;  ///< where scattered light comes from; may be none
};

/// Optical constants of the opal at the wavelengths of a path.
template <int N>
OPAL_HD inline LaneOptics<N> lane_optics(const OpalView& opal, const PathWavelengths<N>& wavelengths) {
    LaneOptics<N> optics;
    for (int i = 0; i < N; ++i) {
        optics.wavelength_nm[i] = wavelengths.wavelength_nm[i];
        optics.n_eff[i] = table_at(opal.n_eff, wavelengths.wavelength_nm[i]);
        optics.contrast[i] = table_at(opal.contrast, wavelengths.wavelength_nm[i]);
        optics.relative_index[i] = table_at(opal.relative_index, wavelengths.wavelength_nm[i]);
        optics.surface_index[i] = table_at(opal.surface_index, wavelengths.wavelength_nm[i]);
    }
    return optics;
}

/// How light is found at points where a straight line leads to it. All three have the same mean.
enum class LightSampling {
    both,         ///< drawn lights and drawn directions, weighted against each other
    connections,  ///< drawn lights alone
    scattering    ///< drawn directions alone
};

struct SceneView {
    Camera camera;
    SpectrumTables spectra;
    EnvironmentView environment;
    LightsView lights;  ///< beside the environment
    LightSampling light_sampling = LightSampling::both;
    const OpalView* bodies = nullptr;  ///< in the order of their priorities, the highest last
    const MeshView* meshes = nullptr;
    const MaterialView* materials = nullptr;
    int num_bodies = 0, num_meshes = 0, num_materials = 0;
    NestedBodies camera_bodies;  ///< that all rays of the camera start in
    NestedBodies cut_bodies;     ///< that some of its rays start in, see camera_bodies.h
    int width = 0, height = 0;
    int max_bounces = 64;
    bool roulette = true;  ///< paths that carry little end at random
    int wavelengths = 4;   ///< 1 + companions
    uint64_t seed = 1;
    PathSampler sampler = PathSampler::stratified;
    PixelFilter filter;
};

/// What a ray met.
struct RayHit {
    real distance_mm = 0.0f;
    uint32_t mesh = 0;
    uint32_t triangle = 0;    ///< of an exact surface: the piece
    real u = 0.0f, v = 0.0f;  ///< barycentric; on an exact surface the patch's parameters
};

/// Geometry at a hit: normals are outward and unit length.
struct Surface {
    Vec3 position;
    Vec3 geometric_normal;
    Vec3 shading_normal;
    int material;
    int body;
};

OPAL_HD inline Surface patch_surface_at(const MeshView& mesh, const RayHit& hit) {
    const BezierPatch& patch = mesh.patches.patches[mesh.patches.pieces[hit.triangle].patch];
    const BezierPoint point = evaluate_bezier(patch, double(hit.u), double(hit.v));
    Surface surface;
    surface.position = {real(point.position_mm[0]), real(point.position_mm[1]), real(point.position_mm[2])};
    surface.geometric_normal = {real(point.normal[0]), real(point.normal[1]), real(point.normal[2])};
    surface.shading_normal = surface.geometric_normal;
    surface.material = mesh.material;
    surface.body = mesh.body;
    return surface;
}

OPAL_HD inline Surface surface_at(const SceneView& scene, const RayHit& hit) {
    const MeshView& mesh = scene.meshes[hit.mesh];
    if (mesh.patches.patches) return patch_surface_at(mesh, hit);
    const uint32_t* corner = mesh.indices + 3 * size_t(hit.triangle);
    const Vec3 a = mesh.positions[corner[0]], b = mesh.positions[corner[1]], c = mesh.positions[corner[2]];
    const real w = 1.0f - hit.u - hit.v;
    Surface surface;
    surface.position = w * a + hit.u * b + hit.v * c;
    surface.geometric_normal = normalize(cross(b - a, c - a));
    surface.shading_normal = surface.geometric_normal;
    if (mesh.normals)
        surface.shading_normal =
            normalize(w * mesh.normals[corner[0]] + hit.u * mesh.normals[corner[1]] + hit.v * mesh.normals[corner[2]]);
    surface.material = mesh.material;
    surface.body = mesh.body;
    return surface;
}

/// A point moved off its surface, towards the side `direction` leaves to, by a little more than its rounding error.
OPAL_HD inline Vec3 offset_origin(Vec3 position, Vec3 geometric_normal, Vec3 direction) {
    const real distance = 4.0e-6f * (1.0f + max_abs(position));
    return position + (dot(direction, geometric_normal) >= 0.0f ? distance : -distance) * geometric_normal;
}

}  // namespace opal
