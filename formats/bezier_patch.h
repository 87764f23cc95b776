// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#if defined(__CUDACC__)
#define OPAL_BEZIER_HD __host__ __device__
#else
#define OPAL_BEZIER_HD
#endif

/// Exact evaluation of bicubic Bezier patches: G. Farin, "Curves and Surfaces for CAGD", 5th ed., 2002, chapters 5 and 14. Plain
/// arrays and functions, for the modeler and for both backends of the renderer.
namespace opal {

/// S(u, v) = sum_ij B_i(u) B_j(v) control_mm[i][j] for u, v in [0, 1], B the cubic Bernstein polynomials. A row or a column at
/// the border may collapse into a point (a pole).
struct BezierPatch {
    double control_mm[4][4][3];
    /// Patches of one part bound a closed solid together; the shape is the union of its parts. Control points are ordered so
    /// that dS/du x dS/dv points out of the part.
    int part;
};

/// A place on a patch with its tangents.
struct BezierPoint {
    double position_mm[3];
    double du_mm[3];   ///< dS/du
    double dv_mm[3];   ///< dS/dv
    double normal[3];  ///< unit length, outward, at a pole its limit; (0, 0, 0) where the surface has none
};

/// Values of the cubic Bernstein polynomials at t; `s` is 1 - t. Exchanging s and t reverses them bit by bit, so that two patches
/// that run along a common edge in opposite directions agree there.
struct BernsteinWeights {
    double value[4];

    OPAL_BEZIER_HD BernsteinWeights(double s, double t) : value{s * s * s, 3.0 * (s * s) * t, 3.0 * (t * t) * s, t * t * t} {}
};

/// Derivatives of the cubic Bernstein polynomials.
struct BernsteinSlopes {
    double value[4];

    OPAL_BEZIER_HD explicit BernsteinSlopes(double t) {
        const double s = 1.0 - t;
        value[0] = -3.0 * s * s;
        value[1] = 3.0 * s * (s - 2.0 * t);
        value[2] = 3.0 * t * (2.0 * s - t);
        value[3] = 3.0 * t * t;
    }
};

/// sum_ij weight_u[i] weight_v[j] control_mm[i][j]; outer terms are added first, so that the order along an edge does not matter.
OPAL_BEZIER_HD inline void bezier_sum(const BezierPatch& patch, const double (&weight_u)[4], const double (&weight_v)[4],
                                      double (&sum)[3]) {
    for (int axis = 0; axis < 3; ++axis) {
        double row[4];
        for (int i = 0; i < 4; ++i)
            row[i] = (weight_v[0] * patch.control_mm[i][0][axis] + weight_v[3] * patch.control_mm[i][3][axis]) +
                     (weight_v[1] * patch.control_mm[i][1][axis] + weight_v[2] * patch.control_mm[i][2][axis]);
        sum[axis] = (weight_u[0] * row[0] + weight_u[3] * row[3]) + (weight_u[1] * row[1] + weight_u[2] * row[2]);
    }
}

namespace bezier_detail {

OPAL_BEZIER_HD inline double dot(const double (&a)[3], const double (&b)[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

OPAL_BEZIER_HD inline void cross(const double (&a)[3], const double (&b)[3], double factor, double (&result)[3]) {
    result[0] = factor * (a[1] * b[2] - a[2] * b[1]);
    result[1] = factor * (a[2] * b[0] - a[0] * b[2]);
    result[2] = factor * (a[0] * b[1] - a[1] * b[0]);
}

}  // namespace bezier_detail

/// The patch at (u, v). Next to a collapsed edge one tangent vanishes in proportion to the distance from the edge; the normal's
/// limit follows from the mixed derivative there: dS/dv = u d2S/dudv + O(u^2) at the edge u = 0, and so on.
inline OPAL_BEZIER_HD BezierPoint evaluate_bezier(const BezierPatch& patch, double u, double v) {
    using bezier_detail::cross;
    using bezier_detail::dot;
    // Ratio of the squared lengths of the tangents below which one of them counts as vanished: there the limit is off by less
    // than 1e-8 rad, while rounding would spoil the product of the tangents.
    constexpr double vanished = 1.0e-16;
    const BernsteinWeights weight_u(1.0 - u, u), weight_v(1.0 - v, v);
    const BernsteinSlopes slope_u(u), slope_v(v);
    BezierPoint point;
    double mixed[3];
    bezier_sum(patch, weight_u.value, weight_v.value, point.position_mm);
    bezier_sum(patch, slope_u.value, weight_v.value, point.du_mm);
    bezier_sum(patch, weight_u.value, slope_v.value, point.dv_mm);
    bezier_sum(patch, slope_u.value, slope_v.value, mixed);
    const double du2 = dot(point.du_mm, point.du_mm), dv2 = dot(point.dv_mm, point.dv_mm), mixed2 = dot(mixed, mixed);
    if (dv2 <= vanished * (du2 < mixed2 ? mixed2 : du2))
        cross(point.du_mm, mixed, u < 0.5 ? 1.0 : -1.0, point.normal);
    else if (du2 <= vanished * (dv2 < mixed2 ? mixed2 : dv2))
        cross(mixed, point.dv_mm, v < 0.5 ? 1.0 : -1.0, point.normal);
    else
        cross(point.du_mm, point.dv_mm, 1.0, point.normal);
    const double length2 = dot(point.normal, point.normal);
    if (length2 > 0.0) {
        const double inverse = 1.0 / std::sqrt(length2);
        for (double& component : point.normal) component *= inverse;
    }
    return point;
}

}  // namespace opal
