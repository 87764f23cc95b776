// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <vector>

namespace opal {

/// A cost at a size.
struct SizedCost {
    double size = 0.0, cost = 0.0;
};

/// cost = c size^exponent, by least squares in logarithms.
struct PowerLaw {
    double exponent = 0.0;
    double standard_error = 0.0;  ///< from the points' scatter about the line; 0 for two points
    double last_exponent = 0.0;   ///< between the last two sizes
};

/// `points`: at least two, of increasing size, all above 0.
inline PowerLaw fit_power_law(const std::vector<SizedCost>& points) {
    double mean_x = 0.0, mean_y = 0.0;
    for (const SizedCost& point : points) {
        mean_x += std::log(point.size) / double(points.size());
        mean_y += std::log(point.cost) / double(points.size());
    }
    double xx = 0.0, xy = 0.0, residuals = 0.0;
    for (const SizedCost& point : points) {
        const double x = std::log(point.size) - mean_x;
        xx += x * x;
        xy += x * (std::log(point.cost) - mean_y);
    }
    PowerLaw law;
    law.exponent = xy / xx;
    for (const SizedCost& point : points) {
        const double residual = std::log(point.cost) - mean_y - law.exponent * (std::log(point.size) - mean_x);
        residuals += residual * residual;
    }
    if (points.size() > 2) law.standard_error = std::sqrt(residuals / double(points.size() - 2) / xx);
    const SizedCost &last = points[points.size() - 1], &before = points[points.size() - 2];
    law.last_exponent = std::log(last.cost / before.cost) / std::log(last.size / before.size);
    return law;
}

}  // namespace opal
