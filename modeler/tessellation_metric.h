// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cmath>

#include "formats/opal_asset.h"
#include "formats/recipe.h"

namespace opal {

/// How far a site is from a point in the sense of a tessellation: x belongs to the site with the smallest delta_i(x), ties going
/// to the lowest index. Each delta_i is slope_i-Lipschitz in the Euclidean distance, which is all that culling needs.
///  - additive, voronoi: |x - p_i| - w_i, w_i in mm (0 for voronoi)
///  - multiplicative:    w_i |x - p_i|, w_i > 0 without unit
///  - manhattan:         |x - p_i|_1 - w_i, w_i in mm
/// One formula, evaluated in one order, decides everywhere, so that equal inputs give equal labels to the last bit.
template <TessellationKind kind>
struct TessellationMetric {
    static double delta_mm(double dx, double dy, double dz, double weight) {
        if constexpr (kind == TessellationKind::manhattan) return std::abs(dx) + std::abs(dy) + std::abs(dz) - weight;
        const double distance_mm = std::sqrt(dx * dx + dy * dy + dz * dz);
        if constexpr (kind == TessellationKind::multiplicative) return weight * distance_mm;
        return distance_mm - weight;
    }

    static double delta_mm(const openvdb::Vec3d& point_mm, const Site& site) {
        return delta_mm(point_mm.x() - site.position_mm.x(), point_mm.y() - site.position_mm.y(),
                        point_mm.z() - site.position_mm.z(), static_cast<double>(site.weight_mm));
    }

    /// Largest change of delta per Euclidean distance.
    static double slope(const Site& site) {
        if constexpr (kind == TessellationKind::multiplicative) return static_cast<double>(site.weight_mm);
        if constexpr (kind == TessellationKind::manhattan) return std::sqrt(3.0);
        return 1.0;
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
