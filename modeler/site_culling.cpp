// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/site_culling.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace opal {

template <typename Metric>
SiteCulling<Metric>::SiteCulling(const std::vector<Site>& sites, const openvdb::BBoxd& bounds_mm) : sites_(sites) {
    double largest_mm = std::max(bounds_mm.min().length(), bounds_mm.max().length());
    for (const Site& site : sites) {
        largest_mm = std::max(largest_mm, site.position_mm.length());
        // A multiplicative weight is a factor: it scales the rounding of its delta as it scales the slope.
        if constexpr (Metric::uniform_slope) largest_mm = std::max(largest_mm, std::abs(static_cast<double>(site.weight_mm)));
    }
    // Each delta carries a few roundings of numbers no larger than this times its slope; 32 of them are plenty.
    rounding_slack_mm_ = 32.0 * std::numeric_limits<double>::epsilon() * largest_mm;
}

template <typename Metric>
void SiteCulling<Metric>::shrink(std::span<const std::int32_t> from, const openvdb::Vec3d& centre_mm, double radius_mm,
                                 Candidates& kept) const {
    // Distances are kept beside the indices for the second pass; the lists of small blocks fit the stack.
    constexpr std::size_t stack_capacity = 256;
    double stack_delta_mm[stack_capacity];
    std::vector<double> heap_delta_mm(from.size() > stack_capacity ? from.size() : 0);
    double* const delta_mm = heap_delta_mm.empty() ? stack_delta_mm : heap_delta_mm.data();

    const double reach_mm = radius_mm + rounding_slack_mm_;
    double limit_mm = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < from.size(); ++n) {
        const Site& site = sites_[static_cast<std::size_t>(from[n])];
        delta_mm[n] = Metric::delta_mm(centre_mm, site);
        // Where all slopes are equal, they are left for the end.
        if constexpr (Metric::uniform_slope) {
            limit_mm = std::min(limit_mm, delta_mm[n]);
        } else {
            limit_mm = std::min(limit_mm, delta_mm[n] + Metric::slope(site) * reach_mm);
            delta_mm[n] -= Metric::slope(site) * reach_mm;
        }
    }
    if constexpr (Metric::uniform_slope)
        if (!from.empty()) limit_mm += 2.0 * Metric::slope(sites_[static_cast<std::size_t>(from.front())]) * reach_mm;
    for (std::size_t n = 0; n < from.size(); ++n)
        if (delta_mm[n] <= limit_mm) kept.push_back(from[n]);
}

template <typename Metric>
void SiteCulling<Metric>::compare_with_nearest(std::size_t first, const openvdb::Vec3d& centre_mm, double radius_mm,
                                               Candidates& kept) const {
    if (kept.size() - first < 2) return;
    const auto site = [this](std::int32_t index) -> const Site& { return sites_[static_cast<std::size_t>(index)]; };
    std::int32_t nearest = kept[first];
    double least_mm = std::numeric_limits<double>::infinity();
    for (std::size_t n = first; n < kept.size(); ++n) {
        const double delta_mm = Metric::delta_mm(centre_mm, site(kept[n]));
        if (delta_mm < least_mm) {
            least_mm = delta_mm;
            nearest = kept[n];
        }
    }
    const double slack_mm = rounding_slack_mm_ * Metric::slope(site(nearest));
    const auto never_nearer = [&](std::int32_t index) {
        if (index == nearest) return false;
        const double slope = Metric::difference_slope(site(index), site(nearest), centre_mm, radius_mm);
        const double behind_mm = Metric::delta_mm(centre_mm, site(index)) - least_mm;
        return behind_mm > slope * radius_mm + slack_mm + rounding_slack_mm_ * Metric::slope(site(index));
    };
    kept.erase(std::remove_if(kept.begin() + static_cast<std::ptrdiff_t>(first), kept.end(), never_nearer), kept.end());
}

template class SiteCulling<TessellationMetric<TessellationKind::additive>>;
template class SiteCulling<TessellationMetric<TessellationKind::multiplicative>>;
template class SiteCulling<TessellationMetric<TessellationKind::manhattan>>;

}  // namespace opal
