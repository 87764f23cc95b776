// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "modeler/bond_order.h"

namespace opal {

/// The grains of an opal at one bond probability.
struct PercolationPoint {
    double p = 0.0;
    double grains = 0.0;            ///< number of grains
    double largest_fraction = 0.0;  ///< visible sites in the largest grain
    double mean_other_size = 0.0;   ///< mean, over the visible sites, of the size in sites of a site's grain, the largest
                                    ///< counted as nothing; peaks at the threshold
};

struct PercolationCurve {
    std::vector<PercolationPoint> points;  ///< p from 0 to 1 in steps of 0.005; of 0.0005 within 0.02 of the threshold
    std::optional<double> threshold;       ///< as `sinter` finds it; none without bonds
};

/// The whole percolation curve of a graph from one sweep over its bonds.
///
/// The sweep knows the grains for every number n of kept bonds. At probability p of M bonds that number is binomial, so a
/// quantity's expectation over which *number* of bonds is kept is Q(p) = sum_n C(M, n) p^n (1 - p)^(M - n) Q_n: equation 2 of
/// Newman & Ziff 2001, summed here to a relative 1e-16 of its terms. Weighted bonds are not kept in equal number by equal p, so
/// for them the curve is that of the one realization, Q(n(p)).
PercolationCurve percolation_curve(const BondOrder& bonds, const std::vector<char>& hidden);

/// As CSV: lines beginning with # that repeat `notes` and name the threshold, then
/// p,grains,grains_per_site,largest_fraction,mean_other_size.
std::string percolation_csv(const PercolationCurve& curve, std::size_t num_visible, const std::vector<std::string>& notes);

}  // namespace opal
