// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal_asset.h"
#include "modeler/tessellation_metric.h"

namespace opal {

/// Sites that may own part of a region, by index, in ascending order.
using Candidates = std::vector<std::int32_t>;

/// Drops the candidates that cannot own a point of a ball. delta_i is slope_i-Lipschitz, so an owner of any point within R of the
/// centre c satisfies delta_i(c) - slope_i R <= min_j (delta_j(c) + slope_j R); rounding is allowed for, so no owner is ever
/// dropped. `Metric` is a TessellationMetric.
template <typename Metric>
class SiteCulling {
  public:
    /// `bounds_mm` encloses every point that will be asked about.
    SiteCulling(const std::vector<Site>& sites, const openvdb::BBoxd& bounds_mm);

    /// Appends the survivors of `from` to `kept`, in their order. The span may point into `kept` only if that has room for all.
    void shrink(std::span<const std::int32_t> from, const openvdb::Vec3d& centre_mm, double radius_mm, Candidates& kept) const;

    /// Drops further candidates, `first` and those after it, that cannot own a point of the ball: by how much farther than the
    /// nearest they are at its centre, and how fast that can change. Pays where the ball is small against its distance from sites
    /// that are close together, whose distances change almost alike.
    void compare_with_nearest(std::size_t first, const openvdb::Vec3d& centre_mm, double radius_mm, Candidates& kept) const;

    const std::vector<Site>& sites() const { return sites_; }

  private:
    const std::vector<Site>& sites_;
    double rounding_slack_mm_;
};

extern template class SiteCulling<TessellationMetric<TessellationKind::additive>>;
extern template class SiteCulling<TessellationMetric<TessellationKind::multiplicative>>;
extern template class SiteCulling<TessellationMetric<TessellationKind::manhattan>>;

}  // namespace opal
