// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/patch_surface.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace opal {
namespace {

/// Of the body's size: how far triangles may be off. They are not seen, but tell what lies inside.
constexpr double chord_part = 1.0e-3;
/// Of the body's size: how flat pieces are, so that a ray seldom meets one twice.
constexpr double piece_part = 4.0e-3;

/// Control points are mapped as points are: an affine map of a patch is the patch of the mapped points.
BezierPatch mapped(const BezierPatch& patch, const RigidTransform& transform) {
    const Quaternion q = transform.rotation;
    const double x = double(q.x), y = double(q.y), z = double(q.z), w = double(q.w), s = double(transform.scale);
    const double matrix[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                                 {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                                 {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    const double origin[3] = {double(transform.origin.x), double(transform.origin.y), double(transform.origin.z)};
    BezierPatch result = patch;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            for (int axis = 0; axis < 3; ++axis) {
                double sum = origin[axis];
                for (int k = 0; k < 3; ++k) sum += s * matrix[axis][k] * patch.control_mm[i][j][k];
                result.control_mm[i][j][axis] = sum;
            }
    return result;
}

/// Bound of the second derivatives, by second differences of the control points (Filip, Magedson & Markot 1986).
double curvature_bound_mm(const BezierPatch& patch) {
    double largest = 0.0;
    const auto second = [&](int i0, int j0, int i1, int j1, int i2, int j2) {
        double square = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            const double d =
                patch.control_mm[i0][j0][axis] - 2.0 * patch.control_mm[i1][j1][axis] + patch.control_mm[i2][j2][axis];
            square += d * d;
        }
        largest = std::max(largest, 6.0 * std::sqrt(square));
    };
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 2; ++j) {
            second(i, j, i, j + 1, i, j + 2);
            second(j, i, j + 1, i, j + 2, i);
        }
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            double square = 0.0;
            for (int axis = 0; axis < 3; ++axis) {
                const double d = patch.control_mm[i + 1][j + 1][axis] - patch.control_mm[i + 1][j][axis] -
                                 patch.control_mm[i][j + 1][axis] + patch.control_mm[i][j][axis];
                square += d * d;
            }
            largest = std::max(largest, 9.0 * std::sqrt(square));
        }
    return largest;
}

double size_mm(const std::vector<BezierPatch>& patches) {
    double low[3] = {1.0e300, 1.0e300, 1.0e300}, high[3] = {-1.0e300, -1.0e300, -1.0e300};
    for (const BezierPatch& patch : patches)
        for (const auto& row : patch.control_mm)
            for (const auto& point : row)
                for (int axis = 0; axis < 3; ++axis) {
                    low[axis] = std::min(low[axis], point[axis]);
                    high[axis] = std::max(high[axis], point[axis]);
                }
    return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

/// All patches are divided alike, so that points on shared edges are equal bit by bit.
void add_patch(const BezierPatch& patch, int parts, MeshData& mesh) {
    const auto first = std::uint32_t(mesh.positions.size());
    mesh.patches.push_back(patch);
    for (int i = 0; i <= parts; ++i)
        for (int j = 0; j <= parts; ++j) {
            // s and t are exchanged exactly when the edge is run the other way.
            const double u = double(i) / parts, v = double(j) / parts;
            const BernsteinWeights weight_u(double(parts - i) / parts, u), weight_v(double(parts - j) / parts, v);
            double position[3];
            bezier_sum(patch, weight_u.value, weight_v.value, position);
            mesh.positions.push_back({float(position[0]), float(position[1]), float(position[2])});
        }
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const auto same = [&](std::uint32_t p, std::uint32_t q) {
            const Vec3 d = mesh.positions[p] - mesh.positions[q];
            return dot(d, d) == 0.0f;
        };
        if (same(a, b) || same(b, c) || same(c, a)) return;
        mesh.indices.insert(mesh.indices.end(), {a, b, c});
    };
    for (int i = 0; i < parts; ++i)
        for (int j = 0; j < parts; ++j) {
            const auto a = first + std::uint32_t(i * (parts + 1) + j), b = a + std::uint32_t(parts) + 1;
            add(a, b, a + 1);
            add(a + 1, b, b + 1);
        }
}

/// Control points of a curve's part [a, a + width], by blossoming.
void part_of_curve(const double (&curve)[4], double a, double width, double (&part)[4]) {
    for (int k = 0; k < 4; ++k) {
        double c[4] = {curve[0], curve[1], curve[2], curve[3]};
        for (int level = 0; level < 3; ++level) {
            const double at = level < k ? a + width : a;
            for (int i = 0; i + level < 3; ++i) c[i] = (1.0 - at) * c[i] + at * c[i + 1];
        }
        part[k] = c[0];
    }
}

/// A cone that holds the normals of a piece: they are sums, with weights that are not negative, of the products of its control
/// points' differences along one parameter with those along the other (Sederberg & Meyers 1988, "Loop detection in surface patch
/// intersections").
void bound_normals(PatchPiece& piece) {
    std::vector<openvdb::Vec3d> products;
    const auto difference = [&](int i, int j, int k, int l) {
        return openvdb::Vec3d(piece.control_mm[0][k][l] - piece.control_mm[0][i][j],
                              piece.control_mm[1][k][l] - piece.control_mm[1][i][j],
                              piece.control_mm[2][k][l] - piece.control_mm[2][i][j]);
    };
    openvdb::Vec3d axis(0.0);
    for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j) {
            openvdb::Vec3d product = difference(i / 4, i % 4, i / 4 + 1, i % 4).cross(difference(j / 3, j % 3, j / 3, j % 3 + 1));
            if (!product.normalize(0.0)) continue;
            products.push_back(product);
            axis += product;
        }
    piece.normal_sine = 2.0f;
    if (!axis.normalize(0.0)) return;
    double least_cosine = 1.0;
    for (const openvdb::Vec3d& product : products) least_cosine = std::min(least_cosine, product.dot(axis));
    for (int k = 0; k < 3; ++k) piece.normal[k] = float(axis[k]);
    // Wider than this a piece is no longer flat.
    if (least_cosine > 0.8) piece.normal_sine = float(std::sqrt(1.0 - least_cosine * least_cosine) + 1.0e-6);
}

/// Halved alike along both parameters; parts is a power of two.
void add_pieces(const BezierPatch& patch, std::uint32_t number, int parts, std::vector<PatchPiece>& pieces) {
    const double width = 1.0 / parts;
    for (int i = 0; i < parts; ++i)
        for (int j = 0; j < parts; ++j) {
            PatchPiece piece = {};
            piece.patch = number;
            piece.u0 = float(i * width);
            piece.v0 = float(j * width);
            piece.width = float(width);
            for (int axis = 0; axis < 3; ++axis) {
                double rows[4][4];
                for (int k = 0; k < 4; ++k) {
                    const double row[4] = {patch.control_mm[k][0][axis], patch.control_mm[k][1][axis],
                                           patch.control_mm[k][2][axis], patch.control_mm[k][3][axis]};
                    part_of_curve(row, j * width, width, rows[k]);
                }
                for (int l = 0; l < 4; ++l) {
                    const double column[4] = {rows[0][l], rows[1][l], rows[2][l], rows[3][l]};
                    double part[4];
                    part_of_curve(column, i * width, width, part);
                    for (int k = 0; k < 4; ++k) piece.control_mm[axis][k][l] = part[k];
                }
            }
            double largest_mm = 0.0;
            for (const auto& axis : piece.control_mm)
                for (const auto& row : axis)
                    for (const double coordinate : row) largest_mm = std::max(largest_mm, std::abs(coordinate));
            piece.largest_mm = float(largest_mm);
            bound_normals(piece);
            pieces.push_back(piece);
        }
}

/// Into how many parts both parameters of a patch are cut to be as flat as this: the largest distance of a split into n by n is
/// (M_uu + 2 M_uv + M_vv) / (8 n^2).
double parts_for(double bound_mm, double tolerance_mm) {
    return std::ceil(std::sqrt(bound_mm / (2.0 * tolerance_mm)));
}

}  // namespace

std::vector<MeshData> surfaces_from_patches(const std::vector<BezierPatch>& patches, const RigidTransform& world_from_object) {
    std::vector<BezierPatch> world;
    double bound_mm = 0.0;
    for (const BezierPatch& patch : patches) {
        world.push_back(mapped(patch, world_from_object));
        bound_mm = std::max(bound_mm, curvature_bound_mm(world.back()));
    }
    const double whole_mm = size_mm(world), tolerance_mm = chord_part * whole_mm;
    const int parts = int(std::clamp(parts_for(bound_mm, tolerance_mm), 4.0, 256.0));
    std::map<int, MeshData> by_part;
    for (const BezierPatch& patch : world) {
        MeshData& mesh = by_part[patch.part];
        add_patch(patch, parts, mesh);
        int pieces = 1;
        while (pieces < 64 && pieces < parts_for(curvature_bound_mm(patch), piece_part * whole_mm)) pieces *= 2;
        add_pieces(patch, std::uint32_t(mesh.patches.size() - 1), pieces, mesh.pieces);
    }
    std::vector<MeshData> meshes;
    for (auto& [part, mesh] : by_part) {
        mesh.deviation_mm = float(tolerance_mm);
        meshes.push_back(std::move(mesh));
    }
    return meshes;
}

}  // namespace opal
