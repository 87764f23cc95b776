// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/bezier_patch.h"
#include "renderer/core/vec.h"

/// Rays against Bezier patches: all places where a ray meets them are found, between the surfaces' own bounds, so that no ray
/// slips through and none meets what is not there. In double: places on a patch are known far better than a float can say, and a
/// start that was moved off the surface (offset_origin) lies on its right side.
namespace opal {

/// A rectangle of parameters of a patch, with its own control points.
struct PatchPiece {
    double control_mm[3][4][4];  ///< axis by axis
    uint32_t patch;
    real u0, v0, width;  ///< parameters of the patch from u0, v0 on; exact binary fractions
    real largest_mm;     ///< coordinate
    real normal[3];      ///< unit axis of a cone that holds all normals
    real normal_sine;    ///< of its half angle; above 1 where it is no cone
};

/// A surface of patches, cut into pieces for the tree of bounds.
struct PatchMeshView {
    const BezierPatch* patches = nullptr;  ///< world space; null where triangles are the surface
    const PatchPiece* pieces = nullptr;
    uint32_t num_patches = 0, num_pieces = 0;
};

/// Where a ray meets a patch.
struct PatchHit {
    real u = 0.0f, v = 0.0f;  ///< of the patch
    real distance_mm = 0.0f;
    bool met = false;
};

namespace bezier_detail {

/// A scalar polynomial in s and t over a box: its Bernstein coefficients.
struct Bicubic {
    double c[4][4];

    /// Whether the coefficients bound it away from zero, or from an interval.
    OPAL_HD bool stays_off(double room) const { return stays_outside(-room, room); }
    OPAL_HD bool stays_outside(double low, double high) const {
        int below = 0, above = 0;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                below += c[i][j] < low ? 1 : 0;
                above += c[i][j] > high ? 1 : 0;
            }
        return below == 16 || above == 16;
    }
    /// Of a third of the derivative along s, or along t.
    OPAL_HD void slope_bounds(bool along_s, double& low, double& high) const {
        double least[4], most[4];
        for (int j = 0; j < 4; ++j) {
            least[j] = 1.0e300;
            most[j] = -1.0e300;
        }
        if (along_s)
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 4; ++j) widen(c[i + 1][j] - c[i][j], least[j], most[j]);
        else
            for (int i = 0; i < 4; ++i)
                for (int j = 0; j < 3; ++j) widen(c[i][j + 1] - c[i][j], least[j], most[j]);
        low = least_of(least);
        high = most_of(most);
    }
    /// Value and derivatives.
    OPAL_HD void evaluate(double s, double t, double& value, double& ds, double& dt) const {
        const BernsteinWeights weight_s(1.0 - s, s), weight_t(1.0 - t, t);
        const BernsteinSlopes slope_s(s), slope_t(t);
        value = ds = dt = 0.0;
        for (int i = 0; i < 4; ++i) {
            double along = 0.0, slope = 0.0;
            for (int j = 0; j < 4; ++j) {
                along += weight_t.value[j] * c[i][j];
                slope += slope_t.value[j] * c[i][j];
            }
            value += weight_s.value[i] * along;
            ds += slope_s.value[i] * along;
            dt += weight_s.value[i] * slope;
        }
    }
    /// Cuts it in the middle (de Casteljau); this becomes the lower half, `upper` the other.
    OPAL_HD void halve(bool along_s, Bicubic& upper) {
        for (int k = 0; k < 4; ++k) {
            double* const first = along_s ? &c[0][k] : &c[k][0];
            double* const last = along_s ? &upper.c[0][k] : &upper.c[k][0];
            const int step = along_s ? 4 : 1;
            const double a = first[0], b = first[step], d = first[2 * step], e = first[3 * step];
            const double ab = 0.5 * (a + b), bd = 0.5 * (b + d), de = 0.5 * (d + e);
            const double abd = 0.5 * (ab + bd), bde = 0.5 * (bd + de), middle = 0.5 * (abd + bde);
            first[step] = ab;
            first[2 * step] = abd;
            first[3 * step] = last[0] = middle;
            last[step] = bde;
            last[2 * step] = de;
            last[3 * step] = e;
        }
    }

  private:
    OPAL_HD static void widen(double x, double& least, double& most) {
        least = x < least ? x : least;
        most = x > most ? x : most;
    }
    OPAL_HD static double least_of(const double (&x)[4]) { return min_of(min_of(x[0], x[1]), min_of(x[2], x[3])); }
    OPAL_HD static double most_of(const double (&x)[4]) { return max_of(max_of(x[0], x[1]), max_of(x[2], x[3])); }
};

/// A piece's component along an axis, less the ray's origin's.
OPAL_HD inline void component(const PatchPiece& piece, const double (&axis)[3], double at_origin, Bicubic& result) {
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            result.c[i][j] = axis[0] * piece.control_mm[0][i][j] + axis[1] * piece.control_mm[1][i][j] +
                             axis[2] * piece.control_mm[2][i][j] - at_origin;
}

/// Part of a piece, and the piece's place in the ray's own frame there: two components across the ray, one along it.
struct PatchBox {
    Bicubic across[2], along;
    double s0, t0;  ///< parameters of the piece
    int halvings_s, halvings_t;
};

/// Whether the Jacobian of the components across can vanish in the box: only then can they vanish at more than one place.
OPAL_HD inline bool may_fold(const PatchBox& box) {
    double fs[2], ft[2], gs[2], gt[2];
    box.across[0].slope_bounds(true, fs[0], fs[1]);
    box.across[0].slope_bounds(false, ft[0], ft[1]);
    box.across[1].slope_bounds(true, gs[0], gs[1]);
    box.across[1].slope_bounds(false, gt[0], gt[1]);
    const auto product = [](const double(&a)[2], const double(&b)[2], double& least, double& most) {
        least = most = a[0] * b[0];
        for (int i = 1; i < 4; ++i) {
            const double p = a[i & 1] * b[i >> 1];
            least = p < least ? p : least;
            most = p > most ? p : most;
        }
    };
    double low[2], high[2];
    product(fs, gt, low[0], high[0]);
    product(ft, gs, low[1], high[1]);
    return low[0] <= high[1] && low[1] <= high[0];
}

/// Newton's method from the middle of a box for the place where both components across vanish. Whether it ends in the box, whose
/// edges belong to it with some room: neighbours may both find a place on their common edge, none may miss it.
OPAL_HD inline bool find_root(const PatchBox& box, double exact_mm, double& s, double& t) {
    constexpr int most_steps = 8;
    constexpr double room = 1.0e-7;
    s = t = 0.5;
    for (int step = 0; step < most_steps; ++step) {
        double f, fs, ft, g, gs, gt;
        box.across[0].evaluate(s, t, f, fs, ft);
        box.across[1].evaluate(s, t, g, gs, gt);
        if (fabs(f) + fabs(g) <= exact_mm) return s >= -room && s <= 1.0 + room && t >= -room && t <= 1.0 + room;
        const double determinant = fs * gt - ft * gs;
        if (determinant == 0.0) return false;
        s -= (f * gt - g * ft) / determinant;
        t -= (g * fs - f * gs) / determinant;
        if (!(s > -1.0 && s < 2.0 && t > -1.0 && t < 2.0)) return false;
    }
    return false;
}

}  // namespace bezier_detail

/// The nearest place beyond 0 and nearer than `max_mm` where a ray meets a piece. Parts that cannot hold one are left out by the
/// bounds of their control points in the ray's frame, the others halved until Newton's method finds the one place there (Kajiya
/// 1982, "Ray tracing parametric patches", for the frame; Toth 1985, "On ray tracing parametric surfaces", for the certainty).
OPAL_HD inline PatchHit meet_piece(const PatchPiece& piece, const Ray& ray, real max_mm) {
    using namespace bezier_detail;
    constexpr int most_halvings = 14;  // of each parameter: two places nearer to each other than that are one touch
    const double along[3] = {double(ray.direction.x), double(ray.direction.y), double(ray.direction.z)};
    const double origin[3] = {double(ray.origin.x), double(ray.origin.y), double(ray.origin.z)};
    const Frame frame(ray.direction);
    const double tangent[3] = {double(frame.tangent.x), double(frame.tangent.y), double(frame.tangent.z)};
    double across[2][3];  // in double, as a float's rounding shows at grazing incidence
    cross(along, tangent, 1.0, across[0]);
    cross(along, across[0], 1.0, across[1]);
    const double inverse = 1.0 / dot(along, along);
    const double forward[3] = {inverse * along[0], inverse * along[1], inverse * along[2]};
    // Of the control points and of their sums: what is farther away is not met.
    const double rounding_mm = 1.0e-14 * (double(piece.largest_mm) + fabs(origin[0]) + fabs(origin[1]) + fabs(origin[2]));

    PatchBox boxes[2 * most_halvings + 2];
    PatchHit nearest;
    component(piece, across[0], dot(across[0], origin), boxes[0].across[0]);
    if (boxes[0].across[0].stays_off(rounding_mm)) return nearest;
    component(piece, across[1], dot(across[1], origin), boxes[0].across[1]);
    if (boxes[0].across[1].stays_off(rounding_mm)) return nearest;
    component(piece, forward, dot(forward, origin), boxes[0].along);
    boxes[0].s0 = boxes[0].t0 = 0.0;
    boxes[0].halvings_s = boxes[0].halvings_t = 0;

    double nearest_mm = double(max_mm);
    const double facing =
        fabs(double(piece.normal[0]) * along[0] + double(piece.normal[1]) * along[1] + double(piece.normal[2]) * along[2]);
    const bool from_one_side = facing > double(piece.normal_sine);
    bool all_of_it = true;  // the box is the whole piece
    for (int count = 1; count > 0;) {
        PatchBox& box = boxes[--count];
        if (box.along.stays_outside(0.0, nearest_mm)) continue;
        if (box.across[0].stays_off(rounding_mm) || box.across[1].stays_off(rounding_mm)) continue;
        double s = 0.5, t = 0.5;
        // So flat a piece, looked at from one side alone, is met once.
        const bool folds = !(all_of_it && from_one_side) && may_fold(box);
        const bool met = !folds && find_root(box, rounding_mm, s, t);
        all_of_it = false;
        const double width_s = 1.0 / double(1 << box.halvings_s), width_t = 1.0 / double(1 << box.halvings_t);
        if (!met && (box.halvings_s < most_halvings || box.halvings_t < most_halvings)) {
            const bool halve_s = box.halvings_s <= box.halvings_t;
            PatchBox& upper = boxes[count + 1];
            upper.halvings_s = box.halvings_s += halve_s ? 1 : 0;
            upper.halvings_t = box.halvings_t += halve_s ? 0 : 1;
            box.across[0].halve(halve_s, upper.across[0]);
            box.across[1].halve(halve_s, upper.across[1]);
            box.along.halve(halve_s, upper.along);
            upper.s0 = box.s0 + (halve_s ? 0.5 * width_s : 0.0);
            upper.t0 = box.t0 + (halve_s ? 0.0 : 0.5 * width_t);
            count += 2;
            continue;
        }
        if (!met && !folds) continue;
        double distance_mm, unused_s, unused_t;
        box.along.evaluate(s, t, distance_mm, unused_s, unused_t);
        if (!(distance_mm > 0.0 && distance_mm < nearest_mm)) continue;
        const double width = double(piece.width);
        const double u = double(piece.u0) + width * (box.s0 + width_s * s), v = double(piece.v0) + width * (box.t0 + width_t * t);
        if (!met) {
            // So small, and still folded: a pole, or a mere touch that crosses the surface nowhere.
            BezierPatch whole;
            for (int i = 0; i < 4; ++i)
                for (int j = 0; j < 4; ++j)
                    for (int axis = 0; axis < 3; ++axis) whole.control_mm[i][j][axis] = piece.control_mm[axis][i][j];
            const BezierPoint point = evaluate_bezier(whole, box.s0 + 0.5 * width_s, box.t0 + 0.5 * width_t);
            constexpr double touch_cosine = 1.0e-3;
            if (fabs(dot(point.normal, along)) < touch_cosine) continue;
        }
        nearest_mm = distance_mm;
        const auto parameter = [](double p) { return real(p < 0.0 ? 0.0 : (p > 1.0 ? 1.0 : p)); };
        nearest = {parameter(u), parameter(v), real(distance_mm), true};
    }
    return nearest;
}

}  // namespace opal
