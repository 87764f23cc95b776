// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/vec.h"

namespace opal {

/// A rectangle as a point sees it, from either side, for drawing directions evenly within its solid angle. In double, as the
/// angles of a rectangle seen at a grazing angle cancel: solid angles and densities are good to 1e-6 down to 1e-6 rad above its
/// plane, the way they are drawn down to `least_drawn_sr`.
class SphericalRectangle {
  public:
    /// The rectangle `centre` +- half_x +- half_y, its edges at right angles.
    OPAL_HD SphericalRectangle(Vec3 centre, Vec3 half_x, Vec3 half_y, Vec3 from) {
        const double half_width = unit(half_x, x_), half_height = unit(half_y, y_);
        cross(x_, y_, z_);
        // The rounding of half_y's direction must not tilt the plane.
        cross(z_, x_, y_);
        const double to[3] = {double(centre.x) - double(from.x), double(centre.y) - double(from.y),
                              double(centre.z) - double(from.z)};
        const double centre_x = dot(to, x_), centre_y = dot(to, y_);
        z0_ = dot(to, z_);
        x0_ = centre_x - half_width;
        x1_ = centre_x + half_width;
        y0_ = centre_y - half_height;
        y1_ = centre_y + half_height;
        half_diagonal2_ = half_width * half_width + half_height * half_height;
        distance2_ = dot(to, to);
        solid_angle_ = triangle(x0_, y0_, x1_, y0_, x1_, y1_) + triangle(x0_, y0_, x1_, y1_, x0_, y1_);
    }

    /// Steradian.
    OPAL_HD double solid_angle() const { return solid_angle_; }

    /// Solid angles below this are for drawing by area: what they send is little.
    static constexpr double least_drawn_sr = 1.0e-4;
    /// Whether the solid angle is worth drawing by: from afar the area is as good, and cheaper.
    OPAL_HD bool worth_drawing() const { return solid_angle_ > least_drawn_sr && distance2_ < 100.0 * half_diagonal2_; }

    /// Unit direction for two uniform numbers, and the distance (mm) to the rectangle along it (Urena, Fajardo & King 2013, "An
    /// area-preserving parametrization for spherical rectangles").
    OPAL_HD Vec3 direction(real u, real v, real& distance_mm) const {
        const double z2 = z0_ * z0_, height = fabs(z0_);
        const double n0 = -y0_ / sqrt(z2 + y0_ * y0_), n2 = y1_ / sqrt(z2 + y1_ * y1_);
        // Inner angles at the corners (x0, y1) and (x0, y0).
        const double g2 = atan2(height * sqrt(z2 + x0_ * x0_ + y1_ * y1_), x0_ * y1_);
        const double g3 = atan2(height * sqrt(z2 + x0_ * x0_ + y0_ * y0_), -x0_ * y0_);
        const double angle = double(u) * solid_angle_ + (2.0 * double(pi_f) - g2 - g3) + pi_rounding;
        const double f = (cos(angle) * n0 - n2) / sin(angle);
        // x = -c z0 / sqrt(1 - c^2) for c = sign(f) / sqrt(f^2 + n0^2), with 1 - n0^2 = z0^2 / (z0^2 + y0^2).
        const double sine2 = f * f - z2 / (z2 + y0_ * y0_);
        const double far_x = sine2 > 0.0 ? copysign(height / sqrt(sine2), f) : copysign(1.0e300, f);
        const double x = clamp(far_x, x0_, x1_);
        const double d2 = x * x + z2;
        const double h0 = y0_ / sqrt(d2 + y0_ * y0_), h1 = y1_ / sqrt(d2 + y1_ * y1_);
        const double h = h0 + double(v) * (h1 - h0);
        const double cosine2 = 1.0 - h * h;
        const double y = cosine2 > 0.0 ? clamp(h * sqrt(d2 / cosine2), y0_, y1_) : y1_;
        const double distance = sqrt(d2 + y * y);
        distance_mm = real(distance);
        const double a = x / distance, b = y / distance, c = z0_ / distance;
        return normalize(Vec3{real(a * x_[0] + b * y_[0] + c * z_[0]), real(a * x_[1] + b * y_[1] + c * z_[1]),
                              real(a * x_[2] + b * y_[2] + c * z_[2])});
    }

  private:
    /// 2 pi is more than twice the float pi_f.
    static constexpr double pi_rounding = 6.283185307179586 - 2.0 * double(pi_f);

    OPAL_HD static double clamp(double x, double low, double high) { return x < low ? low : (x > high ? high : x); }
    OPAL_HD static double dot(const double (&a)[3], const double (&b)[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
    OPAL_HD static void cross(const double (&a)[3], const double (&b)[3], double (&result)[3]) {
        const double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        const double inverse = 1.0 / sqrt(dot(c, c));
        for (int axis = 0; axis < 3; ++axis) result[axis] = inverse * c[axis];
    }
    /// Makes a vector a unit one; its length.
    OPAL_HD static double unit(Vec3 v, double (&result)[3]) {
        const double d[3] = {double(v.x), double(v.y), double(v.z)};
        const double length = sqrt(dot(d, d));
        for (int axis = 0; axis < 3; ++axis) result[axis] = d[axis] / length;
        return length;
    }
    /// Solid angle of half of the rectangle, of corners in its plane (Van Oosterom & Strackee 1983, "The solid angle of a plane
    /// triangle"). Their triple product is the height times the rectangle's area: there nothing cancels.
    OPAL_HD double triangle(double ax, double ay, double bx, double by, double cx, double cy) const {
        const double z2 = z0_ * z0_;
        const double a = sqrt(ax * ax + ay * ay + z2), b = sqrt(bx * bx + by * by + z2), c = sqrt(cx * cx + cy * cy + z2);
        const double below =
            a * b * c + (ax * bx + ay * by + z2) * c + (bx * cx + by * cy + z2) * a + (cx * ax + cy * ay + z2) * b;
        return 2.0 * atan2(fabs(z0_) * (x1_ - x0_) * (y1_ - y0_), below);
    }

    double x_[3], y_[3], z_[3];      ///< frame along the edges
    double x0_, x1_, y0_, y1_, z0_;  ///< the rectangle in it, the point at the origin
    double half_diagonal2_, distance2_;
    double solid_angle_;
};

}  // namespace opal
