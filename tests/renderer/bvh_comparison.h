// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/core/bvh_view.h"
#include "renderer/cpu/embree_scene.h"
#include "renderer/host/bvh.h"

/// The hierarchy for devices against Embree, ray by ray.
namespace opal {

struct ComparedScene {
    std::string name;
    std::vector<MeshData> meshes;
    float radius_mm;     ///< of a ball about the origin that holds it, but for planes
    bool closed;         ///< all its meshes together, about the origin
    bool exact = false;  ///< has patches
};

/// Random triangles of all sizes; a cabochon; a cube of six meshes, square to the axes; a ball in three meshes; exact ellipsoids
/// on a plane.
std::vector<ComparedScene> compared_scenes();

enum class RayKind {
    from_outside,
    from_inside,
    to_edge,
    to_corner,
    along_axis,
    along_axis_to_corner,
    in_plane,
    from_afar,
    from_surface
};
inline constexpr int num_ray_kinds = 9;

/// Ray `index` of a kind.
Ray compared_ray(const ComparedScene& scene, RayKind kind, std::uint64_t index);

/// Corner of a random triangle.
Vec3 compared_corner(const ComparedScene& scene, std::uint64_t index);

struct BvhComparison {
    std::uint64_t rays = 0;
    std::uint64_t met = 0;   ///< by the hierarchy
    std::uint64_t same = 0;  ///< both miss, or meet the same triangle at the same distance within rounding
    std::uint64_t ties = 0;  ///< different triangles at the same distance within rounding
    /// What one of them alone meets: within rounding of the ray's start, ...
    std::uint64_t at_start = 0;
    std::uint64_t at_border = 0;    ///< ... or of the triangle's border
    std::uint64_t edge_on = 0;      ///< ... of a triangle that the ray sees edge-on, on its line
    std::uint64_t unexplained = 0;  ///< anything else
    std::uint64_t first_unexplained = 0;
    std::uint64_t same_bits = 0;        ///< of the distance, where the same triangle is met
    std::uint64_t wrong_occlusion = 0;  ///< where occluded() contradicts closest()
    double largest_share = 0.0;         ///< of the tolerance, that distances to the same triangle differ by
};

/// The rays [first, first + count) of a scene, kinds in turn.
BvhComparison compare_with_embree(const ComparedScene& scene, const BvhView<true>& bvh, const EmbreeScene& embree,
                                  std::uint64_t first, std::uint64_t count);

std::vector<MeshView> views_of(const std::vector<MeshData>& meshes);

}  // namespace opal
