// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "modeler/shape.h"

namespace opal {

/// An axis-aligned box of full extents `size_mm`, resting on z = 0.
class BoxShape final : public Shape {
  public:
    explicit BoxShape(const openvdb::Vec3d& size_mm) : half_size_mm_(0.5 * size_mm) {}

    double signed_distance_mm(const openvdb::Vec3d& point_mm) const override;
    openvdb::BBoxd bounds_mm() const override;

  private:
    openvdb::Vec3d half_size_mm_;
};

}  // namespace opal
