// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>

#include "formats/opal_asset.h"
#include "formats/recipe.h"

namespace opal {

/// How far a site is from a point in the sense of a tessellation: x belongs to the site with the smallest delta_i(x), ties going
/// to the lowest index. Each delta_i is slope_i-Lipschitz in the Euclidean distance, which is all that culling needs.
///  - additive, voronoi: |x - p_i| - w_i, w_i in mm (0 for voronoi)
///  - multiplicative:    w_i |x - p_i|, w_i > 0 without unit
///  - manhattan:         |x - p_i|_1 - w_i, w_i in mm
/// One formula, evaluated in one order, decides everywhere, so that equal inputs give equal labels to the last bit:
/// delta_of_terms_mm(axis_term(dx) + axis_term(dy) + axis_term(dz), weight), summed from the left.
template <TessellationKind kind>
struct TessellationMetric {
    /// Whether all sites have the same slope.
    static constexpr bool uniform_slope = kind != TessellationKind::multiplicative;

    static double axis_term(double offset_mm) {
        if constexpr (kind == TessellationKind::manhattan) return std::abs(offset_mm);
        return offset_mm * offset_mm;
    }

    static double delta_of_terms_mm(double sum_of_terms, double weight) {
        if constexpr (kind == TessellationKind::manhattan) return sum_of_terms - weight;
        const double distance_mm = std::sqrt(sum_of_terms);
        if constexpr (kind == TessellationKind::multiplicative) return weight * distance_mm;
        return distance_mm - weight;
    }

    static double delta_mm(double dx, double dy, double dz, double weight) {
        return delta_of_terms_mm(axis_term(dx) + axis_term(dy) + axis_term(dz), weight);
    }

    static double delta_mm(const openvdb::Vec3d& point_mm, const Site& site) {
        return delta_mm(point_mm.x() - site.position_mm.x(), point_mm.y() - site.position_mm.y(),
                        point_mm.z() - site.position_mm.z(), static_cast<double>(site.weight_mm));
    }

    /// Gradient of delta; 0 at the site itself.
    static openvdb::Vec3d gradient(const openvdb::Vec3d& point_mm, const Site& site) {
        const openvdb::Vec3d offset_mm = point_mm - site.position_mm;
        if constexpr (kind == TessellationKind::manhattan) {
            const auto sign = [](double value) { return value > 0.0 ? 1.0 : value < 0.0 ? -1.0 : 0.0; };
            return {sign(offset_mm.x()), sign(offset_mm.y()), sign(offset_mm.z())};
        }
        return offset_mm.unitSafe() * slope(site);
    }

    /// Largest change of delta per Euclidean distance.
    static double slope(const Site& site) {
        if constexpr (kind == TessellationKind::multiplicative) return static_cast<double>(site.weight_mm);
        if constexpr (kind == TessellationKind::manhattan) return std::sqrt(3.0);
        return 1.0;
    }

    /// Largest change of delta_a - delta_b per Euclidean distance within a ball: far from two sites that are near each other both
    /// distances change almost alike.
    static double difference_slope(const Site& a, const Site& b, const openvdb::Vec3d& centre_mm, double radius_mm) {
        const openvdb::Vec3d& from_a = a.position_mm;
        const openvdb::Vec3d& from_b = b.position_mm;
        if constexpr (kind == TessellationKind::manhattan) {
            // Along an axis the difference changes, by 2, between the sites alone.
            int axes = 0;
            for (int axis = 0; axis < 3; ++axis)
                axes += std::min(from_a[axis], from_b[axis]) <= centre_mm[axis] + radius_mm &&
                                std::max(from_a[axis], from_b[axis]) >= centre_mm[axis] - radius_mm
                            ? 1
                            : 0;
            return 2.0 * std::sqrt(static_cast<double>(axes));
        }
        // Unit vectors along two vectors differ by at most 2 |v - w| / (|v| + |w|) (Dunkl & Williams 1964).
        const double distances_mm = (centre_mm - from_a).length() + (centre_mm - from_b).length() - 2.0 * radius_mm;
        const double apart_mm = (from_a - from_b).length();
        const double turn = apart_mm < distances_mm ? 2.0 * apart_mm / distances_mm : 2.0;
        return std::min(slope(a), slope(b)) * turn + std::abs(slope(a) - slope(b));
    }

    /// Whether `other`, `offset_mm` away, is at least as near as `site` wherever `site` could own a point; where both own the
    /// same, the one that comes `first` does.
    static bool hides(const Site& other, const Site& site, const openvdb::Vec3d& offset_mm, bool first) {
        const double lead = static_cast<double>(other.weight_mm) - static_cast<double>(site.weight_mm);
        if constexpr (kind == TessellationKind::multiplicative)
            return offset_mm == openvdb::Vec3d(0.0) && (lead < 0.0 || (lead == 0.0 && first));
        const double distance_mm = delta_mm(offset_mm.x(), offset_mm.y(), offset_mm.z(), 0.0);
        return lead > distance_mm || (lead == distance_mm && (distance_mm > 0.0 || first));
    }
};

/// Calls `work` with the metric of `kind`: with_metric(kind, [&](auto metric) { using Metric = decltype(metric); ... }).
template <typename Work>
auto with_metric(TessellationKind kind, const Work& work) {
    switch (kind) {
        case TessellationKind::multiplicative:
            return work(TessellationMetric<TessellationKind::multiplicative>());
        case TessellationKind::manhattan:
            return work(TessellationMetric<TessellationKind::manhattan>());
        default:
            return work(TessellationMetric<TessellationKind::additive>());
    }
}

}  // namespace opal
