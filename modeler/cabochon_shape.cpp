// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/cabochon_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/error.h"
#include "modeler/ellipsoid_distance.h"

namespace opal {

CabochonShape::CabochonShape(const openvdb::Vec3d& size_mm, double girdle_mm)
    : half_size_mm_(0.5 * size_mm),
      inner_semi_axes_mm_(0.5 * size_mm.x() - 0.5 * girdle_mm, 0.5 * size_mm.y() - 0.5 * girdle_mm, size_mm.z() - girdle_mm),
      rounding_mm_(0.5 * girdle_mm) {
    const double thinnest_mm = std::min({inner_semi_axes_mm_.x(), inner_semi_axes_mm_.y(), inner_semi_axes_mm_.z()});
    if (!(girdle_mm >= 0.0) || !(thinnest_mm > 0.0))
        throw InputError(fmt::format("shape.girdle_mm {} must be at least 0 and less than each of size_mm [{}, {}, {}]",
                                     girdle_mm, size_mm.x(), size_mm.y(), size_mm.z()));
}

double CabochonShape::half_ellipsoid_distance_mm(const openvdb::Vec3d& point_mm) const {
    if (point_mm.z() >= 0.0) {
        const double dome_mm =
            signed_distance_to_ellipsoid<3>({inner_semi_axes_mm_.x(), inner_semi_axes_mm_.y(), inner_semi_axes_mm_.z()},
                                            {point_mm.x(), point_mm.y(), point_mm.z()});
        return dome_mm < 0.0 ? std::max(dome_mm, -point_mm.z()) : dome_mm;
    }
    const double rim_mm =
        signed_distance_to_ellipsoid<2>({inner_semi_axes_mm_.x(), inner_semi_axes_mm_.y()}, {point_mm.x(), point_mm.y()});
    return rim_mm <= 0.0 ? -point_mm.z() : std::sqrt(rim_mm * rim_mm + point_mm.z() * point_mm.z());
}

double CabochonShape::signed_distance_mm(const openvdb::Vec3d& point_mm) const {
    return half_ellipsoid_distance_mm({point_mm.x(), point_mm.y(), point_mm.z() - rounding_mm_}) - rounding_mm_;
}

openvdb::BBoxd CabochonShape::bounds_mm() const {
    return {{-half_size_mm_.x(), -half_size_mm_.y(), 0.0}, {half_size_mm_.x(), half_size_mm_.y(), 2.0 * half_size_mm_.z()}};
}

}  // namespace opal
