// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal_asset.h"

namespace opal {

/// Distance of the additively weighted diagram, delta_i(x) = |x - p_i| - w_i, in mm: x belongs to the site where it is smallest.
/// This one formula, evaluated in this order, decides everywhere, so that equal inputs give equal labels to the last bit.
inline double weighted_distance_mm(const openvdb::Vec3d& point_mm, const Site& site) {
    const double dx = point_mm.x() - site.position_mm.x();
    const double dy = point_mm.y() - site.position_mm.y();
    const double dz = point_mm.z() - site.position_mm.z();
    return std::sqrt(dx * dx + dy * dy + dz * dz) - static_cast<double>(site.weight_mm);
}

/// Sites that may own part of a region, by index, in ascending order.
using Candidates = std::vector<std::int32_t>;

/// Drops the candidates that cannot own a point of a ball. delta_i is 1-Lipschitz, so an owner of any point within R of the
/// centre c satisfies delta_i(c) <= min_j delta_j(c) + 2 R; rounding is allowed for, so no owner is ever dropped.
class SiteCulling {
  public:
    /// `bounds_mm` encloses every point that will be asked about.
    SiteCulling(const std::vector<Site>& sites, const openvdb::BBoxd& bounds_mm);

    /// Appends the survivors of `from` to `kept`, in their order. The span may point into `kept` only if that has room for all.
    void shrink(std::span<const std::int32_t> from, const openvdb::Vec3d& centre_mm, double radius_mm, Candidates& kept) const;

    const std::vector<Site>& sites() const { return sites_; }

  private:
    const std::vector<Site>& sites_;
    double rounding_slack_mm_;
};

}  // namespace opal
