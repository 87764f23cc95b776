// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/mesh_contact.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace opal {
namespace {

using openvdb::Vec3d;

Vec3d in_double(Vec3 v) {
    return {double(v.x), double(v.y), double(v.z)};
}

using Polygon = std::vector<Vec3d>;

/// The part of a convex polygon where normal . p <= most (Sutherland & Hodgman 1974, "Reentrant polygon clipping").
Polygon clipped(const Polygon& polygon, const Vec3d& normal, double most) {
    Polygon result;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double height_a = normal.dot(a) - most, height_b = normal.dot(b) - most;
        if (height_a <= 0.0) result.push_back(a);
        if ((height_a < 0.0 && height_b > 0.0) || (height_a > 0.0 && height_b < 0.0))
            result.push_back(a + height_a / (height_a - height_b) * (b - a));
    }
    return result;
}

/// The part with |axis . p| <= most.
Polygon clipped_between(const Polygon& polygon, const Vec3d& axis, double most) {
    return clipped(clipped(polygon, axis, most), -axis, most);
}

double segment_distance2(const Vec3d& a, const Vec3d& b) {
    const Vec3d along = b - a;
    const double length2 = along.lengthSqr();
    const double t = length2 > 0.0 ? std::clamp(-a.dot(along) / length2, 0.0, 1.0) : 0.0;
    return (a + t * along).lengthSqr();
}

/// Squared distance of a convex polygon from the origin.
double distance2(const Polygon& polygon) {
    double least = 1.0e300;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        least = std::min(least, segment_distance2(polygon[i], polygon[(i + 1) % polygon.size()]));
    if (polygon.size() < 3) return least;
    const Vec3d normal = (polygon[1] - polygon[0]).cross(polygon[2] - polygon[0]);
    bool above_inside = normal.lengthSqr() > 0.0;
    for (std::size_t i = 0; above_inside && i < polygon.size(); ++i) {
        const Vec3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        above_inside = normal.dot((b - a).cross(-a)) >= 0.0;
    }
    const double height = normal.dot(polygon[0]);
    return above_inside ? height * height / normal.lengthSqr() : least;
}

/// Whether a triangle for which `touches` holds, in coordinates about `centre`, is among the mesh's.
template <typename Touches>
bool any_triangle(const MeshData& mesh, Vec3 centre, const Touches& touches) {
    const Vec3d origin = in_double(centre);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        Polygon triangle(3);
        for (std::size_t k = 0; k < 3; ++k) triangle[k] = in_double(mesh.positions[mesh.indices[i + k]]) - origin;
        if (touches(triangle)) return true;
    }
    return false;
}

/// Of coordinates like these as floats.
double rounding_mm(Vec3 place) {
    return 1.0e-6 * (1.0 + double(max_abs(place)));
}

}  // namespace

bool touches_rectangle(const MeshData& mesh, Vec3 centre, Vec3 half_x, Vec3 half_y, double margin_mm) {
    Vec3d x = in_double(half_x), y = in_double(half_y);
    margin_mm += rounding_mm(centre);
    const double most_x = x.length() + margin_mm, most_y = y.length() + margin_mm;
    x.normalize();
    y.normalize();
    const Vec3d normal = x.cross(y);
    return any_triangle(mesh, centre, [&](const Polygon& triangle) {
        const Polygon flat = clipped_between(triangle, normal, margin_mm);
        return !flat.empty() && !clipped_between(clipped_between(flat, x, most_x), y, most_y).empty();
    });
}

bool touches_light(const MeshData& mesh, const LightGeometry& light) {
    const double margin_mm = rounding_mm(light.position), radius_mm = double(light.radius_mm) + margin_mm;
    switch (light.shape) {
        case LightShape::sun:
            return false;
        case LightShape::rectangle:
            return touches_rectangle(mesh, light.position, light.half_x, light.half_y, 0.0);
        case LightShape::sphere:
            return any_triangle(mesh, light.position,
                                [&](const Polygon& triangle) { return distance2(triangle) <= radius_mm * radius_mm; });
        case LightShape::disk:
            break;
    }
    const Vec3d normal = in_double(light.normal);
    return any_triangle(mesh, light.position, [&](const Polygon& triangle) {
        const Polygon flat = clipped_between(triangle, normal, margin_mm);
        return !flat.empty() && distance2(flat) <= radius_mm * radius_mm;
    });
}

}  // namespace opal
