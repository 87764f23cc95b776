// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/real.h"

namespace opal {

inline constexpr real pi_f = real(3.14159265358979323846);

template <typename A, typename B>
OPAL_HD inline auto min_of(A a, B b) {
    return b < a ? b : a;
}
template <typename A, typename B>
OPAL_HD inline auto max_of(A a, B b) {
    return a < b ? b : a;
}
OPAL_HD inline real square(real x) {
    return x * x;
}

struct Vec3 {
    real x = 0.0f, y = 0.0f, z = 0.0f;
};

OPAL_HD inline Vec3 operator+(Vec3 a, Vec3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
OPAL_HD inline Vec3 operator-(Vec3 a, Vec3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
OPAL_HD inline Vec3 operator-(Vec3 a) {
    return {-a.x, -a.y, -a.z};
}
OPAL_HD inline Vec3 operator*(real s, Vec3 a) {
    return {s * a.x, s * a.y, s * a.z};
}
OPAL_HD inline Vec3 operator*(Vec3 a, real s) {
    return s * a;
}
OPAL_HD inline real dot(Vec3 a, Vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
OPAL_HD inline Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
OPAL_HD inline real length(Vec3 a) {
    return sqrt(dot(a, a));
}
OPAL_HD inline Vec3 normalize(Vec3 a) {
    return (1.0f / length(a)) * a;
}
OPAL_HD inline real max_abs(Vec3 a) {
    return max_of(fabs(a.x), max_of(fabs(a.y), fabs(a.z)));
}

/// Mirror image of a direction in the plane with unit normal `normal`.
OPAL_HD inline Vec3 mirror(Vec3 direction, Vec3 normal) {
    return direction - (2.0f * dot(direction, normal)) * normal;
}

struct Ray {
    Vec3 origin;
    Vec3 direction;  ///< unit length
};

/// Orthonormal frame around a unit normal (Duff et al. 2017, "Building an orthonormal basis, revisited").
struct Frame {
    Vec3 tangent, bitangent, normal;

    OPAL_HD explicit Frame(Vec3 n) : normal(n) {
        const real sign = copysign(1.0f, n.z);
        const real a = -1.0f / (sign + n.z);
        const real b = n.x * n.y * a;
        tangent = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
        bitangent = {b, sign + n.y * n.y * a, -n.y};
    }
    OPAL_HD Vec3 world_from_local(Vec3 v) const { return v.x * tangent + v.y * bitangent + v.z * normal; }
    OPAL_HD Vec3 local_from_world(Vec3 v) const { return {dot(v, tangent), dot(v, bitangent), dot(v, normal)}; }
};

/// Unit quaternion (x, y, z, w), the order of the file.
struct Quaternion {
    real x = 0.0f, y = 0.0f, z = 0.0f, w = 1.0f;

    OPAL_HD Quaternion conjugate() const { return {-x, -y, -z, w}; }
    /// The rotation `other` followed by this one.
    OPAL_HD Quaternion operator*(Quaternion other) const {
        return {w * other.x + x * other.w + y * other.z - z * other.y, w * other.y - x * other.z + y * other.w + z * other.x,
                w * other.z + x * other.y - y * other.x + z * other.w, w * other.w - x * other.x - y * other.y - z * other.z};
    }
    OPAL_HD Vec3 rotate(Vec3 v) const {
        const Vec3 q{x, y, z};
        const Vec3 t = 2.0f * cross(q, v);
        return v + w * t + cross(q, t);
    }
};

/// Rotation, uniform scale and translation between an object's own space and the world: world = scale * rotation(local) + origin.
struct RigidTransform {
    Quaternion rotation;
    Vec3 origin;
    real scale = 1.0f;

    OPAL_HD Vec3 world_from_local_direction(Vec3 v) const { return rotation.rotate(v); }
    OPAL_HD Vec3 local_from_world_direction(Vec3 v) const { return rotation.conjugate().rotate(v); }
    OPAL_HD Vec3 world_from_local_point(Vec3 p) const { return origin + scale * rotation.rotate(p); }
    OPAL_HD Vec3 local_from_world_point(Vec3 p) const { return (1.0f / scale) * rotation.conjugate().rotate(p - origin); }
};

}  // namespace opal
