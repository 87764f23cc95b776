// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "modeler/shape.h"

namespace opal {

/// An ellipsoid (or sphere) of full extents `size_mm`, resting on z = 0.
class EllipsoidShape final : public Shape {
  public:
    explicit EllipsoidShape(const openvdb::Vec3d& size_mm);

    double signed_distance_mm(const openvdb::Vec3d& point_mm) const override;
    bool contains(const openvdb::Vec3d& point_mm) const override;
    openvdb::BBoxd bounds_mm() const override;

  private:
    openvdb::Vec3d semi_axes_mm_;
};

}  // namespace opal
