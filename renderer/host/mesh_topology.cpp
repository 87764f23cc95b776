// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/mesh_topology.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "formats/units.h"

namespace opal {
namespace {

/// Normal of a triangle, twice its area long.
Vec3 face_vector(const MeshData& mesh, std::size_t triangle) {
    const std::uint32_t* corner = mesh.indices.data() + 3 * triangle;
    const Vec3 a = mesh.positions[corner[0]];
    return cross(mesh.positions[corner[1]] - a, mesh.positions[corner[2]] - a);
}

float corner_angle_rad(const MeshData& mesh, std::size_t triangle, int k) {
    const std::uint32_t* corner = mesh.indices.data() + 3 * triangle;
    const Vec3 at = mesh.positions[corner[k]];
    const Vec3 a = mesh.positions[corner[(k + 1) % 3]] - at, b = mesh.positions[corner[(k + 2) % 3]] - at;
    return std::atan2(length(cross(a, b)), dot(a, b));
}

}  // namespace

std::vector<std::uint32_t> vertex_places(const MeshData& mesh) {
    std::vector<std::uint32_t> order(mesh.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t v) {
        const Vec3 p = mesh.positions[v];
        return std::make_tuple(p.x + 0.0f, p.y + 0.0f, p.z + 0.0f);  // -0 is 0
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::vector<std::uint32_t> place(order.size());
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i > 0 && key(order[i - 1]) < key(order[i])) ++count;
        place[order[i]] = count;
    }
    return place;
}

std::size_t count_open_edges(const MeshData& mesh) {
    const std::vector<std::uint32_t> place = vertex_places(mesh);
    struct Edge {
        std::uint32_t low, high;
        int way;
    };
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = place[mesh.indices[i + k]], b = place[mesh.indices[i + (k + 1) % 3]];
            if (a != b) edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
        }
    std::sort(edges.begin(), edges.end(),
              [](const Edge& a, const Edge& b) { return std::tie(a.low, a.high) < std::tie(b.low, b.high); });
    std::size_t open = 0;
    for (std::size_t first = 0; first < edges.size();) {
        int balance = 0;
        std::size_t next = first;
        for (; next < edges.size() && edges[next].low == edges[first].low && edges[next].high == edges[first].high; ++next)
            balance += edges[next].way;
        open += balance != 0 ? 1 : 0;
        first = next;
    }
    return open;
}

double signed_volume6(const MeshData& mesh) {
    double sum = 0.0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        sum += double(dot(mesh.positions[mesh.indices[i]],
                          cross(mesh.positions[mesh.indices[i + 1]], mesh.positions[mesh.indices[i + 2]])));
    return sum;
}

void turn_inside_out(MeshData& mesh) {
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
    for (Vec3& normal : mesh.normals) normal = -normal;
}

void add_crease_normals(MeshData& mesh, double crease_deg) {
    const std::vector<std::uint32_t> place = vertex_places(mesh);
    const std::size_t triangles = mesh.indices.size() / 3;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> corners;  // place, corner
    for (std::size_t c = 0; c < mesh.indices.size(); ++c) corners.emplace_back(place[mesh.indices[c]], std::uint32_t(c));
    std::sort(corners.begin(), corners.end());
    std::vector<Vec3> face(triangles);
    for (std::size_t t = 0; t < triangles; ++t) {
        const Vec3 vector = face_vector(mesh, t);
        const float size = length(vector);
        face[t] = size > 0.0f ? (1.0f / size) * vector : Vec3{};
    }
    // Rounding must not part triangles that lie in one plane.
    const float least_cosine = float(std::cos(units::rad_from_deg(crease_deg))) - 1.0e-5f;
    MeshData split;
    split.positions.resize(mesh.indices.size());
    split.normals.resize(mesh.indices.size());
    split.indices.resize(mesh.indices.size());
    for (std::size_t first = 0, next = 0; first < corners.size(); first = next) {
        while (next < corners.size() && corners[next].first == corners[first].first) ++next;
        for (std::size_t i = first; i < next; ++i) {
            const std::size_t corner = corners[i].second;
            const Vec3 own = face[corner / 3];
            Vec3 sum;
            for (std::size_t j = first; j < next; ++j) {
                const std::size_t other = corners[j].second;
                if (dot(own, face[other / 3]) >= least_cosine)
                    sum = sum + corner_angle_rad(mesh, other / 3, int(other % 3)) * face[other / 3];
            }
            const float size = length(sum);
            split.positions[corner] = mesh.positions[mesh.indices[corner]];
            split.normals[corner] = size > 0.0f ? (1.0f / size) * sum : own;
            split.indices[corner] = std::uint32_t(corner);
        }
    }
    split.material = mesh.material;
    split.body = mesh.body;
    mesh = std::move(split);
}

}  // namespace opal
