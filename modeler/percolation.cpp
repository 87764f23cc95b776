// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/percolation.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace opal {
namespace {

/// p is counted in these, so that steps meet round numbers.
constexpr int steps_per_unit = 2000;
constexpr int coarse_steps = 10;
constexpr int fine_range_steps = 40;
/// Terms of the binomial sum below this part of the largest are left out.
constexpr double negligible = 1.0e-16;

/// A sweep's quantities for every number of kept bonds.
struct SweepCurves {
    std::vector<double> grains, largest_fraction, mean_other_size;

    PercolationPoint at(std::size_t num_kept) const {
        return {0.0, grains[num_kept], largest_fraction[num_kept], mean_other_size[num_kept]};
    }
};

SweepCurves record_sweep(const BondOrder& bonds, std::size_t num_sites, std::size_t num_visible, ThresholdFinder& finder) {
    SweepCurves curves;
    for (auto* values : {&curves.grains, &curves.largest_fraction, &curves.mean_other_size}) values->reserve(bonds.size() + 1);
    sweep_bonds(bonds, num_sites, num_visible, [&](const BondSweepState& state) {
        finder.visit(state, num_visible);
        curves.grains.push_back(static_cast<double>(state.num_grains));
        curves.largest_fraction.push_back(static_cast<double>(state.largest) /
                                          static_cast<double>(std::max<std::size_t>(1, num_visible)));
        curves.mean_other_size.push_back(state.mean_other_size(num_visible));
    });
    return curves;
}

void add(PercolationPoint& sum, const PercolationPoint& term, double weight) {
    sum.grains += weight * term.grains;
    sum.largest_fraction += weight * term.largest_fraction;
    sum.mean_other_size += weight * term.mean_other_size;
}

/// The binomial sum at p, outwards from its largest term by the ratios of neighbouring terms.
PercolationPoint binomial_mean(const SweepCurves& curves, std::size_t num_bonds, double p) {
    if (p <= 0.0) return curves.at(0);
    if (p >= 1.0) return curves.at(num_bonds);
    const auto count = static_cast<double>(num_bonds);
    const auto mode = std::min(num_bonds, static_cast<std::size_t>((count + 1.0) * p));
    PercolationPoint sum;
    double sum_of_weights = 0.0;
    const auto take = [&](std::size_t n, double weight) {
        add(sum, curves.at(n), weight);
        sum_of_weights += weight;
    };
    take(mode, 1.0);
    double weight = 1.0;
    for (std::size_t n = mode; n < num_bonds && weight > negligible; ++n) {
        weight *= (count - static_cast<double>(n)) / static_cast<double>(n + 1) * p / (1.0 - p);
        take(n + 1, weight);
    }
    weight = 1.0;
    for (std::size_t n = mode; n > 0 && weight > negligible; --n) {
        weight *= static_cast<double>(n) / (count - static_cast<double>(n) + 1.0) * (1.0 - p) / p;
        take(n - 1, weight);
    }
    PercolationPoint mean;
    add(mean, sum, 1.0 / sum_of_weights);
    return mean;
}

std::vector<double> probabilities(std::optional<double> threshold) {
    const int middle = threshold ? static_cast<int>(std::lround(*threshold * steps_per_unit)) : -steps_per_unit;
    std::vector<double> p;
    for (int step = 0; step <= steps_per_unit; ++step)
        if (step % coarse_steps == 0 || std::abs(step - middle) <= fine_range_steps)
            p.push_back(static_cast<double>(step) / steps_per_unit);
    return p;
}

}  // namespace

PercolationCurve percolation_curve(const BondOrder& bonds, const std::vector<char>& hidden) {
    const auto num_visible = static_cast<std::size_t>(std::count(hidden.begin(), hidden.end(), char(0)));
    ThresholdFinder finder;
    const SweepCurves curves = record_sweep(bonds, hidden.size(), num_visible, finder);
    PercolationCurve curve;
    curve.threshold = finder.threshold(bonds);
    const std::vector<double> p = probabilities(curve.threshold);
    curve.points.resize(p.size());
    tbb::parallel_for(std::size_t(0), p.size(), [&](std::size_t n) {
        curve.points[n] = bonds.weighted() ? curves.at(bonds.num_kept(p[n])) : binomial_mean(curves, bonds.size(), p[n]);
        curve.points[n].p = p[n];
    });
    return curve;
}

std::string percolation_csv(const PercolationCurve& curve, std::size_t num_visible, const std::vector<std::string>& notes) {
    std::string text;
    for (const std::string& note : notes) text += "# " + note + "\n";
    text += curve.threshold ? fmt::format("# threshold {:.6g}\n", *curve.threshold) : std::string("# threshold none\n");
    text += "p,grains,grains_per_site,largest_fraction,mean_other_size\n";
    const auto sites = static_cast<double>(std::max<std::size_t>(1, num_visible));
    for (const PercolationPoint& point : curve.points)
        text += fmt::format("{},{:.8g},{:.8g},{:.8g},{:.8g}\n", point.p, point.grains, point.grains / sites,
                            point.largest_fraction, point.mean_other_size);
    return text;
}

}  // namespace opal
