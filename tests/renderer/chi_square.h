// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "formats/random.h"

/// The one adapter that every sampler is tested through, in one dimension or two. A new sampler is a few lines:
///
///     TEST(Samplers, Disc) {
///         EXPECT_TRUE(check_sampler(
///             "disc", SamplerDomain<2>{{-1.0, -1.0}, {1.0, 1.0}, {32, 32}},
///             [](SamplerRandom& random) { return SamplerPoint<2>{...}; },  // any number of random.next()
///             [](SamplerPoint<2> p) { return p[0] * p[0] + p[1] * p[1] < 1.0 ? 1.0 / pi : 0.0; }));
///     }
///
/// A million points are drawn and counted in equal cells of the domain; the density is integrated over each cell, adaptively and
/// far below the statistical error; cells that expect fewer than 5 points are pooled; Pearson's statistic of the rest decides.
/// The density is per unit of the domain's own coordinates and complete: it integrates to 1 over the domain, and a point
/// outside is an error. Choose coordinates that spread the probability over many cells: the angle rather than the cosine, say,
/// where a density has a peak.
namespace opal {

template <std::size_t dimensions>
using SamplerPoint = std::array<double, dimensions>;

template <std::size_t dimensions>
struct SamplerDomain {
    SamplerPoint<dimensions> low, high;
    std::array<int, dimensions> cells;
};

/// Probability that any of so many checks of right samplers fails; each gets its share (Sidak 1967).
inline constexpr double family_significance = 1.0e-2;
inline constexpr int num_sampler_checks = 200;

/// The random numbers of one draw: a pure function of its index.
class SamplerRandom {
  public:
    explicit SamplerRandom(std::uint64_t index) : index_(index) {}

    float next() {
        if (used_ % 4 == 0) block_ = random_block(12345, RandomStream::bench, index_, used_ / 4);
        return uniform_float(block_.value[used_++ % 4]);
    }

  private:
    std::uint64_t index_;
    RandomBlock block_ = {};
    std::uint32_t used_ = 0;
};

/// Probability of a chi-square statistic at least as large: the finite sums that the incomplete gamma function is for whole and
/// half orders (Abramowitz & Stegun 1964, eqs. 26.4.4 and 26.4.5).
inline double chi_square_tail(double statistic, int degrees_of_freedom) {
    const double half = 0.5 * statistic;
    const bool odd = degrees_of_freedom % 2 == 1;
    double tail = odd ? std::erfc(std::sqrt(half)) : 0.0;
    for (double order = odd ? 0.5 : 0.0; order < 0.5 * degrees_of_freedom - 0.75; order += 1.0)
        tail += std::exp(order * std::log(half) - half - std::lgamma(order + 1.0));
    return tail;
}

/// Upper quantile of the chi-square distribution (Wilson & Hilferty 1931; good to a part in a thousand from 10 degrees of
/// freedom), for a normal quantile `z`: 4.75 is a probability of 1e-6. For tests that bring a statistic of their own.
inline double chi_square_limit(int degrees_of_freedom, double z = 4.75) {
    const double k = degrees_of_freedom;
    const double t = 1.0 - 2.0 / (9.0 * k) + z * std::sqrt(2.0 / (9.0 * k));
    return k * t * t * t;
}

namespace chi_square_detail {

/// Halvings that no agreement makes unnecessary: a step in a corner would escape the first points.
inline constexpr int blind_levels = 2;

/// Integral of a density over a box by Gauss's rule of three points along each axis, halved along all axes until two levels
/// agree within `tolerance`.
template <std::size_t dimensions, typename Density>
double integrate(const Density& density, SamplerPoint<dimensions> low, SamplerPoint<dimensions> high, double tolerance,
                 int levels, int blind = blind_levels) {
    const auto gauss = [&](const SamplerPoint<dimensions>& from, const SamplerPoint<dimensions>& to) {
        constexpr double place[3] = {-0.7745966692414834, 0.0, 0.7745966692414834}, weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
        double sum = 0.0, volume = 1.0;
        for (std::size_t axis = 0; axis < dimensions; ++axis) volume *= to[axis] - from[axis];
        for (int k = 0; k < (dimensions == 1 ? 3 : 9); ++k) {
            SamplerPoint<dimensions> point;
            double share = 1.0;
            for (std::size_t axis = 0; axis < dimensions; ++axis) {
                const int i = axis == 0 ? k % 3 : k / 3;
                point[axis] = 0.5 * (from[axis] + to[axis]) + 0.5 * place[i] * (to[axis] - from[axis]);
                share *= weight[i];
            }
            sum += share * density(point);
        }
        return sum * volume;
    };
    constexpr unsigned parts = 1u << dimensions;
    std::array<SamplerPoint<dimensions>, parts> from, to;
    double fine = 0.0;
    for (unsigned part = 0; part < parts; ++part) {
        for (std::size_t axis = 0; axis < dimensions; ++axis) {
            const double middle = 0.5 * (low[axis] + high[axis]);
            const bool upper = (part >> axis & 1u) != 0;
            from[part][axis] = upper ? middle : low[axis];
            to[part][axis] = upper ? high[axis] : middle;
        }
        fine += gauss(from[part], to[part]);
    }
    if (levels == 0 || (blind == 0 && std::abs(fine - gauss(low, high)) < tolerance)) return fine;
    double sum = 0.0;
    for (unsigned part = 0; part < parts; ++part)
        sum += integrate<dimensions>(density, from[part], to[part], tolerance / parts, levels - 1, blind > 0 ? blind - 1 : 0);
    return sum;
}

struct Cell {
    double expected = 0.0;
    double observed = 0.0;
    std::string where;
};

/// Joins cells in their order until each expects enough points for Pearson's statistic.
inline std::vector<Cell> pooled(const std::vector<Cell>& cells) {
    std::vector<Cell> result;
    bool open = false;
    for (const Cell& cell : cells) {
        if (!open) result.push_back({0.0, 0.0, cell.where});
        result.back().expected += cell.expected;
        result.back().observed += cell.observed;
        open = result.back().expected < 5.0;
    }
    if (open && result.size() > 1) {
        result[result.size() - 2].expected += result.back().expected;
        result[result.size() - 2].observed += result.back().observed;
        result.pop_back();
    }
    return result;
}

inline ::testing::AssertionResult compare(const std::string& name, const std::vector<Cell>& cells, double total) {
    if (!(std::abs(total - 1.0) < 1.0e-3))
        return ::testing::AssertionFailure() << name << ": the density integrates to " << total << " over the domain";
    std::vector<Cell> compared = pooled(cells);
    double statistic = 0.0;
    for (const Cell& cell : compared)
        statistic += (cell.observed - cell.expected) * (cell.observed - cell.expected) / cell.expected;
    const int degrees_of_freedom = int(compared.size()) - 1;
    if (degrees_of_freedom < 10) return ::testing::AssertionFailure() << name << ": fewer than 11 cells are ever met";
    const double tail = chi_square_tail(statistic, degrees_of_freedom);
    const double significance = 1.0 - std::pow(1.0 - family_significance, 1.0 / num_sampler_checks);
    if (tail >= significance) return ::testing::AssertionSuccess();
    const auto contribution = [](const Cell& cell) { return std::abs(cell.observed - cell.expected) / std::sqrt(cell.expected); };
    std::stable_sort(compared.begin(), compared.end(),
                     [&](const Cell& a, const Cell& b) { return contribution(a) > contribution(b); });
    std::string worst;
    for (std::size_t i = 0; i < std::min<std::size_t>(5, compared.size()); ++i)
        worst +=
            fmt::format("\n  from {}: {} drawn, {:.1f} expected", compared[i].where, compared[i].observed, compared[i].expected);
    return ::testing::AssertionFailure() << fmt::format("{}: chi-square {:.1f} of {} degrees of freedom, probability {:.2g}{}",
                                                        name, statistic, degrees_of_freedom, tail, worst);
}

}  // namespace chi_square_detail

/// Whether `sample(SamplerRandom&)` draws points of the domain with `density(point)`; see the top of this file.
template <std::size_t dimensions, typename Sample, typename Density>
::testing::AssertionResult check_sampler(const std::string& name, const SamplerDomain<dimensions>& domain, const Sample& sample,
                                         const Density& density, int draws = 1'000'000) {
    using chi_square_detail::Cell;
    std::size_t num_cells = 1;
    for (const int cells : domain.cells) num_cells *= std::size_t(cells);
    std::vector<Cell> cells(num_cells);
    for (int i = 0; i < draws; ++i) {
        SamplerRandom random{std::uint64_t(i)};
        const SamplerPoint<dimensions> point = sample(random);
        std::size_t cell = 0;
        for (std::size_t axis = 0; axis < dimensions; ++axis) {
            const double low = domain.low[axis], high = domain.high[axis];
            if (!(point[axis] >= low && point[axis] <= high))
                return ::testing::AssertionFailure() << name << ": draw " << i << " is at " << point[axis] << ", outside";
            const int place = int((point[axis] - low) / (high - low) * domain.cells[axis]);
            cell = cell * std::size_t(domain.cells[axis]) + std::size_t(std::min(place, domain.cells[axis] - 1));
        }
        cells[cell].observed += 1.0;
    }
    double total = 0.0;
    for (std::size_t c = 0; c < num_cells; ++c) {
        SamplerPoint<dimensions> low, high;
        std::size_t rest = c;
        for (std::size_t axis = dimensions; axis-- > 0;) {
            const auto count = std::size_t(domain.cells[axis]);
            const double width = (domain.high[axis] - domain.low[axis]) / double(count);
            low[axis] = domain.low[axis] + width * double(rest % count);
            high[axis] = low[axis] + width;
            rest /= count;
        }
        // A fiftieth of the standard deviation of the count that an average cell expects.
        const double tolerance = 0.02 * std::sqrt(double(draws) / double(num_cells)) / draws;
        const double probability =
            chi_square_detail::integrate<dimensions>(density, low, high, tolerance, dimensions == 1 ? 14 : 5);
        total += probability;
        cells[c].expected = probability * draws;
        cells[c].where = fmt::format("[{:.6g}]", fmt::join(low, ", "));
    }
    return chi_square_detail::compare(name, cells, total);
}

/// The same for a sampler in one dimension that inverts a cumulative distribution.
template <typename Sample, typename Density>
::testing::AssertionResult check_inversion(const std::string& name, double low, double high, const Sample& sample,
                                           const Density& density, int cells = 64) {
    return check_sampler(
        name, SamplerDomain<1>{{low}, {high}, {cells}},
        [&](SamplerRandom& random) { return SamplerPoint<1>{double(sample(random.next()))}; },
        [&](SamplerPoint<1> point) { return double(density(point[0])); });
}

}  // namespace opal
