// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "modeler/shape.h"

namespace opal {

/// A cabochon: an elliptical dome over a flat base, its girdle rounded with radius girdle_mm / 2. It is the Minkowski sum of a
/// ball of that radius and a half ellipsoid, so its surface has no edges, its extents are exactly `size_mm`, and its distance is
/// that of the (convex) half ellipsoid less the radius, inside as well as outside.
class CabochonShape final : public Shape {
  public:
    /// Throws InputError where the girdle leaves no dome.
    CabochonShape(const openvdb::Vec3d& size_mm, double girdle_mm);

    double signed_distance_mm(const openvdb::Vec3d& point_mm) const override;
    openvdb::BBoxd bounds_mm() const override;

  private:
    /// Distance to the half ellipsoid z >= 0 about the origin with the inner semi-axes.
    double half_ellipsoid_distance_mm(const openvdb::Vec3d& point_mm) const;

    openvdb::Vec3d half_size_mm_;
    openvdb::Vec3d inner_semi_axes_mm_;
    double rounding_mm_;
};

}  // namespace opal
