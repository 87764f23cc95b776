// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "formats/random.h"

namespace opal {

/// Upper quantile of the chi-square distribution (Wilson & Hilferty 1931; good to a part in a thousand from 10 degrees of
/// freedom), for a normal quantile `z`: 4.75 is a probability of 1e-6, so that dozens of tests together stay below 1e-4 of false
/// alarms.
inline double chi_square_limit(int degrees_of_freedom, double z = 4.75) {
    const double k = degrees_of_freedom;
    const double t = 1.0 - 2.0 / (9.0 * k) + z * std::sqrt(2.0 / (9.0 * k));
    return k * t * t * t;
}

/// The one adapter that every sampler is tested through: draws `count` values in [low, high] from `sample(u)`, counts them in
/// equal bins and compares with the integral of `density` (need not be normalized to 1 beyond rounding). True where they agree.
inline bool density_matches(const std::function<double(double u)>& sample, const std::function<double(double x)>& density,
                            double low, double high, int count = 1'000'000, int bins = 64) {
    std::vector<double> observed(std::size_t(bins), 0.0);
    for (int i = 0; i < count; ++i) {
        const RandomBlock block = random_block(12345, RandomStream::render_paths, std::uint64_t(i), 0);
        const double x = sample(uniform_double(block.value[0], block.value[1]));
        if (!(x >= low && x <= high)) return false;
        const int bin = std::min(bins - 1, int((x - low) / (high - low) * bins));
        observed[std::size_t(bin)] += 1.0;
    }
    double statistic = 0.0;
    int used = 0;
    for (int bin = 0; bin < bins; ++bin) {
        // Simpson's rule in 64 steps: smooth densities to far below the statistical error.
        const double a = low + (high - low) * bin / bins, width = (high - low) / bins;
        double integral = 0.0;
        for (int k = 0; k <= 64; ++k) integral += (k == 0 || k == 64 ? 1.0 : (k % 2 ? 4.0 : 2.0)) * density(a + width * k / 64.0);
        const double expected = integral * width / (3.0 * 64.0) * count;
        if (expected < 5.0) {
            if (observed[std::size_t(bin)] > 40.0) return false;
            continue;
        }
        statistic += (observed[std::size_t(bin)] - expected) * (observed[std::size_t(bin)] - expected) / expected;
        ++used;
    }
    return statistic < chi_square_limit(used - 1);
}

}  // namespace opal
