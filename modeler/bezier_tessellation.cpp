// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/bezier_tessellation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "formats/error.h"
#include "modeler/union_find.h"

namespace opal {
namespace {

constexpr double max_triangles = 2.0e7;
/// The flatter parameter of a patch is taken to bend at least this part as much as the other: keeps triangles from being needles.
constexpr double least_bending = 1.0 / 64.0;

openvdb::Vec3d control(const BezierPatch& patch, int i, int j) {
    return openvdb::Vec3d(patch.control_mm[i][j]);
}

/// Bounds on |S_uu|, |S_uv|, |S_vv| over the patch.
struct SecondDerivativeBounds {
    double uu = 0.0, uv = 0.0, vv = 0.0;

    explicit SecondDerivativeBounds(const BezierPatch& p) {
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                if (i < 2)
                    uu = std::max(uu, 6.0 * (control(p, i + 2, j) - 2.0 * control(p, i + 1, j) + control(p, i, j)).length());
                if (j < 2)
                    vv = std::max(vv, 6.0 * (control(p, i, j + 2) - 2.0 * control(p, i, j + 1) + control(p, i, j)).length());
                if (i < 3 && j < 3)
                    uv = std::max(
                        uv,
                        9.0 *
                            (control(p, i + 1, j + 1) - control(p, i + 1, j) - control(p, i, j + 1) + control(p, i, j)).length());
            }
    }
};

int whole_parts(double parts) {
    return static_cast<int>(std::clamp(std::ceil(parts * (1.0 - 1.0e-12)), 1.0, 1.0e6));
}

/// The fewest triangles within the error: the two pure terms of the bound are equal where the product of the counts is least.
PatchSplit needed_split(const BezierPatch& patch, double chord_error_mm) {
    const SecondDerivativeBounds bounds(patch);
    const double uu = std::max(bounds.uu, least_bending * bounds.vv), vv = std::max(bounds.vv, least_bending * bounds.uu);
    if (uu == 0.0)
        return {whole_parts(std::sqrt(bounds.uv / (4.0 * chord_error_mm))),
                whole_parts(std::sqrt(bounds.uv / (4.0 * chord_error_mm)))};
    const double step = std::sqrt(4.0 * chord_error_mm / (1.0 + bounds.uv / std::sqrt(uu * vv)));
    return {whole_parts(std::sqrt(uu) / step), whole_parts(std::sqrt(vv) / step)};
}

/// Control points of an edge, in the direction that comes first in order: equal for both patches that share it.
using EdgeKey = std::array<std::array<double, 3>, 4>;

EdgeKey edge_key(const BezierPatch& patch, bool along_u, bool far_side) {
    EdgeKey key;
    for (int n = 0; n < 4; ++n) {
        const int side = far_side ? 3 : 0;
        const auto& point = along_u ? patch.control_mm[n][side] : patch.control_mm[side][n];
        // Adding zero makes equal what differs in the sign of a zero.
        for (std::size_t axis = 0; axis < 3; ++axis) key[std::size_t(n)][axis] = point[axis] + 0.0;
    }
    EdgeKey reversed = key;
    std::reverse(reversed.begin(), reversed.end());
    return std::min(key, reversed);
}

bool is_collapsed(const EdgeKey& key) {
    return key[0] == key[1] && key[0] == key[2] && key[0] == key[3];
}

class PatchTriangles {
  public:
    PatchTriangles(const BezierPatch& patch, const PatchSplit& split, TriangleMesh& mesh)
        : split_(split), first_(static_cast<std::uint32_t>(mesh.vertices_mm.size())), mesh_(mesh) {
        for (int i = 0; i <= split.along_u; ++i)
            for (int j = 0; j <= split.along_v; ++j) mesh.vertices_mm.push_back(point_mm(patch, i, j));
        for (int i = 0; i < split.along_u; ++i)
            for (int j = 0; j < split.along_v; ++j) {
                add(vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1));
                add(vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1));
            }
    }

  private:
    openvdb::Vec3d point_mm(const BezierPatch& patch, int i, int j) const {
        // The weights' sum is 1 but for rounding: without this, a pole would be many points.
        for (const bool far_side : {false, true}) {
            if (i == (far_side ? split_.along_u : 0) && is_collapsed(edge_key(patch, false, far_side)))
                return control(patch, far_side ? 3 : 0, 0);
            if (j == (far_side ? split_.along_v : 0) && is_collapsed(edge_key(patch, true, far_side)))
                return control(patch, 0, far_side ? 3 : 0);
        }
        const BernsteinWeights u(double(split_.along_u - i) / split_.along_u, double(i) / split_.along_u);
        const BernsteinWeights v(double(split_.along_v - j) / split_.along_v, double(j) / split_.along_v);
        double sum_mm[3];
        bezier_sum(patch, u.value, v.value, sum_mm);
        return openvdb::Vec3d(sum_mm);
    }

    std::uint32_t vertex(int i, int j) const { return first_ + static_cast<std::uint32_t>(i * (split_.along_v + 1) + j); }

    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const auto& v = mesh_.vertices_mm;
        if (v[a] != v[b] && v[b] != v[c] && v[c] != v[a]) mesh_.triangles.emplace_back(a, b, c);
    }

    PatchSplit split_;
    std::uint32_t first_;
    TriangleMesh& mesh_;
};

}  // namespace

double chord_error_bound_mm(const BezierPatch& patch, const PatchSplit& split) {
    const SecondDerivativeBounds bounds(patch);
    const double step_u = 1.0 / split.along_u, step_v = 1.0 / split.along_v;
    return (bounds.uu * step_u * step_u + 2.0 * bounds.uv * step_u * step_v + bounds.vv * step_v * step_v) / 8.0;
}

std::vector<PatchSplit> split_patches(const std::vector<BezierPatch>& patches, double chord_error_mm) {
    // Opposite edges of a patch have one count, and so have the edges that patches share: counts belong to classes of edges.
    // Class 2 n is patch n's u direction, 2 n + 1 its v direction.
    UnionFind classes(2 * patches.size());
    std::map<EdgeKey, std::size_t> class_of_edge;
    for (std::size_t n = 0; n < patches.size(); ++n)
        for (const bool along_u : {true, false})
            for (const bool far_side : {false, true}) {
                const EdgeKey key = edge_key(patches[n], along_u, far_side);
                if (is_collapsed(key)) continue;
                const std::size_t own = classes.root(2 * n + (along_u ? 0 : 1));
                const std::size_t shared = classes.root(class_of_edge.try_emplace(key, own).first->second);
                if (own != shared) classes.join(own, shared);
            }
    std::vector<int> count(2 * patches.size(), 1);
    for (std::size_t n = 0; n < patches.size(); ++n) {
        const PatchSplit needed = needed_split(patches[n], chord_error_mm);
        int& along_u = count[classes.root(2 * n)];
        along_u = std::max(along_u, needed.along_u);
        int& along_v = count[classes.root(2 * n + 1)];
        along_v = std::max(along_v, needed.along_v);
    }
    std::vector<PatchSplit> splits;
    for (std::size_t n = 0; n < patches.size(); ++n)
        splits.push_back({count[classes.root(2 * n)], count[classes.root(2 * n + 1)]});
    return splits;
}

TriangleMesh tessellate(const std::vector<BezierPatch>& patches, double chord_error_mm) {
    const std::vector<PatchSplit> splits = split_patches(patches, chord_error_mm);
    double triangles = 0.0;
    for (const PatchSplit& split : splits) triangles += 2.0 * split.along_u * split.along_v;
    if (!(triangles <= max_triangles))
        throw InputError(fmt::format("shape.chord_error_mm {:.3g}: would take {:.3g} triangles; at most {:.3g} are possible",
                                     chord_error_mm, triangles, max_triangles));
    TriangleMesh mesh;
    for (std::size_t n = 0; n < patches.size(); ++n) PatchTriangles(patches[n], splits[n], mesh);
    return mesh;
}

}  // namespace opal
