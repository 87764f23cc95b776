// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/vec.h"

/// Rays against triangles, such that no ray passes between two of them that share an edge or a vertex (Woop, Benthin & Wald 2013,
/// "Watertight ray/triangle intersection").
namespace opal {

/// Where a ray meets a triangle.
struct TriangleHit {
    real distance_mm = 0.0f;
    real u = 0.0f, v = 0.0f;  ///< weights of the second and of the third corner
    bool met = false;
};

/// a b - c d, wrong by at most 1.5 units in the last place, so that its sign is right (Kahan's algorithm; bound: Jeannerod,
/// Louvet & Muller 2013, "Further analysis of Kahan's algorithm for the accurate computation of 2 x 2 determinants"): two
/// triangles never disagree on which side of their common edge a ray is, whatever products the compiler fuses.
OPAL_HD inline real difference_of_products(real a, real b, real c, real d) {
    const real second = c * d;
    return fma(a, b, -second) + fma(-c, d, second);
}

/// A ray's own frame: sheared so that the ray runs along z, the axis that it is nearest to.
class RayFrame {
  public:
    OPAL_HD explicit RayFrame(const Ray& ray) : origin_(ray.origin), direction_(ray.direction) {
        const Vec3 size{fabs(ray.direction.x), fabs(ray.direction.y), fabs(ray.direction.z)};
        axis_ = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
        const Vec3 turned = turn(ray.direction);
        inverse_ = 1.0f / turned.z;
        shear_x_ = turned.x * inverse_;
        shear_y_ = turned.y * inverse_;
    }

    /// The triangle a, b, c where it lies beyond 0 and not beyond `max_mm`; its border belongs to it.
    OPAL_HD TriangleHit meet(Vec3 a, Vec3 b, Vec3 c, real max_mm) const {
        TriangleHit hit;
        const Vec3 p = sheared(a), q = sheared(b), r = sheared(c);
        const real weight_a = difference_of_products(r.x, q.y, r.y, q.x);
        const real weight_b = difference_of_products(p.x, r.y, p.y, r.x);
        const real weight_c = difference_of_products(q.x, p.y, q.y, p.x);
        if ((weight_a < 0.0f || weight_b < 0.0f || weight_c < 0.0f) && (weight_a > 0.0f || weight_b > 0.0f || weight_c > 0.0f))
            return hit;
        const real sum = weight_a + weight_b + weight_c;
        if (sum == 0.0f) return hit;
        const real distance_mm = plane_distance_mm(a, b, c, p.z, q.z, r.z);
        if (!(distance_mm > 0.0f && distance_mm <= max_mm)) return hit;
        hit = {distance_mm, weight_b / sum, weight_c / sum, true};
        return hit;
    }

  private:
    /// Cyclic, so that the axis comes last.
    OPAL_HD Vec3 turn(Vec3 v) const { return axis_ == 0 ? Vec3{v.y, v.z, v.x} : (axis_ == 1 ? Vec3{v.z, v.x, v.y} : v); }
    /// z: where the ray passes the place's coordinate along the axis. The same bits for the same place, in whichever triangle.
    OPAL_HD Vec3 sheared(Vec3 place) const {
        const Vec3 v = turn(place - origin_);
        return {fma(-shear_x_, v.z, v.x), fma(-shear_y_, v.z, v.y), inverse_ * v.z};
    }
    /// To the triangle's plane, by its own edges alone: large triangles close to the ray's origin and aligned with an axis are
    /// far better known so than by weighing their corners. Within the corners' range, which the plane of a triangle seen edge-on
    /// need not keep.
    OPAL_HD real plane_distance_mm(Vec3 a, Vec3 b, Vec3 c, real at_a, real at_b, real at_c) const {
        const real least = min_of(at_a, min_of(at_b, at_c)), most = max_of(at_a, max_of(at_b, at_c));
        const Vec3 normal = cross(b - a, c - a);
        const real distance_mm = dot(normal, a - origin_) / dot(normal, direction_);
        if (distance_mm >= least) return min_of(distance_mm, most);
        return least;
    }

    Vec3 origin_, direction_;
    int axis_;
    real shear_x_, shear_y_, inverse_;
};

}  // namespace opal
