// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/site_culling.h"

#include <algorithm>
#include <limits>

namespace opal {

SiteCulling::SiteCulling(const std::vector<Site>& sites, const openvdb::BBoxd& bounds_mm) : sites_(sites) {
    double largest_mm = std::max(bounds_mm.min().length(), bounds_mm.max().length());
    for (const Site& site : sites)
        largest_mm = std::max({largest_mm, site.position_mm.length(), std::abs(static_cast<double>(site.weight_mm))});
    // Each delta carries a few roundings of numbers no larger than this; 64 of them are plenty for the comparison of two.
    rounding_slack_mm_ = 64.0 * std::numeric_limits<double>::epsilon() * largest_mm;
}

void SiteCulling::shrink(std::span<const std::int32_t> from, const openvdb::Vec3d& centre_mm, double radius_mm,
                         Candidates& kept) const {
    // Distances are kept beside the indices for the second pass; the lists of small blocks fit the stack.
    constexpr std::size_t stack_capacity = 256;
    double stack_delta_mm[stack_capacity];
    std::vector<double> heap_delta_mm(from.size() > stack_capacity ? from.size() : 0);
    double* const delta_mm = heap_delta_mm.empty() ? stack_delta_mm : heap_delta_mm.data();

    double smallest_mm = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < from.size(); ++n) {
        delta_mm[n] = weighted_distance_mm(centre_mm, sites_[static_cast<std::size_t>(from[n])]);
        smallest_mm = std::min(smallest_mm, delta_mm[n]);
    }
    const double limit_mm = smallest_mm + 2.0 * radius_mm + rounding_slack_mm_;
    for (std::size_t n = 0; n < from.size(); ++n)
        if (delta_mm[n] <= limit_mm) kept.push_back(from[n]);
}

}  // namespace opal
