// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/ellipsoid_shape.h"

#include "modeler/ellipsoid_distance.h"

namespace opal {

EllipsoidShape::EllipsoidShape(const openvdb::Vec3d& size_mm) : semi_axes_mm_(0.5 * size_mm) {}

double EllipsoidShape::signed_distance_mm(const openvdb::Vec3d& point_mm) const {
    return signed_distance_to_ellipsoid<3>({semi_axes_mm_.x(), semi_axes_mm_.y(), semi_axes_mm_.z()},
                                           {point_mm.x(), point_mm.y(), point_mm.z() - semi_axes_mm_.z()});
}

bool EllipsoidShape::contains(const openvdb::Vec3d& point_mm) const {
    const openvdb::Vec3d scaled(point_mm.x() / semi_axes_mm_.x(), point_mm.y() / semi_axes_mm_.y(),
                                point_mm.z() / semi_axes_mm_.z() - 1.0);
    return scaled.lengthSqr() < 1.0;
}

openvdb::BBoxd EllipsoidShape::bounds_mm() const {
    return {{-semi_axes_mm_.x(), -semi_axes_mm_.y(), 0.0}, {semi_axes_mm_.x(), semi_axes_mm_.y(), 2.0 * semi_axes_mm_.z()}};
}

}  // namespace opal
