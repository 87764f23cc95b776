// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "stability_rows.h"

/// Grains near the percolation threshold.
namespace opal {

/// What sintering gives over seeds of the bonds alone, of additive cells in a ball.
struct PercolationSpread {
    Estimate largest;                ///< share of the sites in the largest grain
    double largest_deviation = 0.0;  ///< of one seed
    double grains_deviation = 0.0;   ///< of the number of grains, over its mean
    double threshold_deviation = 0.0;
    double threshold = 0.0;  ///< as the program reports it, mean
    double warned = 0.0;     ///< share of the seeds for which one grain holds more than a fifth of the sites
    int seeds = 0;
};
std::vector<PercolationSpread> percolation_spread(std::size_t sites, const std::vector<double>& probabilities, int seeds);

void add_percolation_rows(bool quick, StabilityRows& rows);

}  // namespace opal
