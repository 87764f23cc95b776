// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/host/mesh_data.h"

namespace opal {

/// For each vertex the number of its place: vertices at equal positions have the same one.
std::vector<std::uint32_t> vertex_places(const MeshData& mesh);

/// Edges without a partner: a mesh without them encloses what it bounds. Triangles count by the places of their vertices; an edge
/// needs as many triangles that run along it one way as the other.
std::size_t count_open_edges(const MeshData& mesh);

/// Six times the volume that a closed mesh encloses, negative where its triangles face inward.
double signed_volume6(const MeshData& mesh);

/// Turns all triangles, and normals with them, the other way round.
void turn_inside_out(MeshData& mesh);

/// Replaces normals: at each corner of a triangle the mean of the normals of the triangles around its place that deviate from its
/// own by at most `crease_deg`, each counting by its angle there (Thuermer & Wuethrich 1998, "Computing vertex normals from
/// polygonal facets").
void add_crease_normals(MeshData& mesh, double crease_deg);

}  // namespace opal
