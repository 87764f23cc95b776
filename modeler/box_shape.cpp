// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/box_shape.h"

#include <algorithm>
#include <cmath>

namespace opal {

double BoxShape::signed_distance_mm(const openvdb::Vec3d& point_mm) const {
    const openvdb::Vec3d beyond_face(std::abs(point_mm.x()) - half_size_mm_.x(), std::abs(point_mm.y()) - half_size_mm_.y(),
                                     std::abs(point_mm.z() - half_size_mm_.z()) - half_size_mm_.z());
    const double nearest_face = std::max({beyond_face.x(), beyond_face.y(), beyond_face.z()});
    if (nearest_face <= 0.0) return nearest_face;
    const openvdb::Vec3d outside(std::max(beyond_face.x(), 0.0), std::max(beyond_face.y(), 0.0), std::max(beyond_face.z(), 0.0));
    return outside.length();
}

openvdb::BBoxd BoxShape::bounds_mm() const {
    return {{-half_size_mm_.x(), -half_size_mm_.y(), 0.0}, {half_size_mm_.x(), half_size_mm_.y(), 2.0 * half_size_mm_.z()}};
}

}  // namespace opal
