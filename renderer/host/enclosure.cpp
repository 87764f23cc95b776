// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/enclosure.h"

#include <algorithm>
#include <cmath>

namespace opal {
namespace {

/// A triangle in object space.
struct Triangle {
    Vec3 a, b, c;
};

/// What a body's level set covers, object mm.
struct Bounds {
    Vec3 low, high;

    bool apart_from(const Triangle& t) const {
        const auto apart = [](float a, float b, float c, float least, float most) {
            return std::max({a, b, c}) < least || std::min({a, b, c}) > most;
        };
        return apart(t.a.x, t.b.x, t.c.x, low.x, high.x) || apart(t.a.y, t.b.y, t.c.y, low.y, high.y) ||
               apart(t.a.z, t.b.z, t.c.z, low.z, high.z);
    }
};

Bounds bounds_of(const FieldView& shape) {
    const nanovdb::CoordBBox& voxels = shape.grid->tree().bbox();
    const auto place = [&](const nanovdb::Coord& voxel) {
        return (1.0f / shape.voxels_per_mm) * (Vec3{float(voxel[0]), float(voxel[1]), float(voxel[2])} - shape.index_of_origin);
    };
    return {place(voxels.min()), place(voxels.max())};
}

/// By parts: a part is clear of the body where the level set, which grows no faster than distance, is larger at its centre than
/// the part can make up for.
bool triangle_reaches_inside(const FieldView& shape, const Bounds& bounds, const Triangle& t) {
    if (bounds.apart_from(t)) return false;
    const float voxel_mm = 1.0f / shape.voxels_per_mm;
    const Vec3 centre = (1.0f / 3.0f) * (t.a + t.b + t.c);
    const float radius_mm = std::max({length(t.a - centre), length(t.b - centre), length(t.c - centre)});
    if (field_value(shape, centre) - radius_mm >= -0.5f * voxel_mm) return false;
    // Small enough to take the centre for the whole.
    if (radius_mm < 0.25f * voxel_mm) return true;
    // Halves across the longest edge: parts of a sliver become compact, where like parts would stay slivers, ever so many.
    const float ab = length(t.b - t.a), bc = length(t.c - t.b), ca = length(t.a - t.c);
    const Triangle from_longest = ab >= bc && ab >= ca ? t : (bc >= ca ? Triangle{t.b, t.c, t.a} : Triangle{t.c, t.a, t.b});
    const auto& [a, b, c] = from_longest;
    const Vec3 middle = 0.5f * (a + b);
    return triangle_reaches_inside(shape, bounds, {a, middle, c}) || triangle_reaches_inside(shape, bounds, {middle, b, c});
}

}  // namespace

bool encloses(const MeshData& mesh, Vec3 point) {
    double solid_angle = 0.0;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const Vec3 a = mesh.positions[mesh.indices[i]] - point, b = mesh.positions[mesh.indices[i + 1]] - point,
                   c = mesh.positions[mesh.indices[i + 2]] - point;
        const double la = double(length(a)), lb = double(length(b)), lc = double(length(c));
        const double volume = double(dot(a, cross(b, c)));
        const double denominator = la * lb * lc + double(dot(a, b)) * lc + double(dot(b, c)) * la + double(dot(c, a)) * lb;
        solid_angle += 2.0 * std::atan2(volume, denominator);
    }
    return std::abs(solid_angle) > 2.0 * double(pi_f);
}

bool reaches_inside(const MeshData& mesh, const OpalView& body) {
    if (!body.shape.grid) return false;
    const Bounds bounds = bounds_of(body.shape);
    const auto corner = [&](std::size_t i) {
        return body.world_from_object.local_from_world_point(mesh.positions[mesh.indices[i]]);
    };
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
        if (triangle_reaches_inside(body.shape, bounds, {corner(i), corner(i + 1), corner(i + 2)})) return true;
    return false;
}

}  // namespace opal
