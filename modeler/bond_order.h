// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "modeler/neighbour_graph.h"
#include "modeler/union_find.h"

namespace opal {

/// The bonds of a graph in the order in which a growing probability p keeps them.
///
/// Every bond has a uniform random number u, a pure function of (seed, its two sites). Without weights a bond is kept where
/// u < p. With weights omega the bonds race: bond k arrives at the time t = -ln(1 - u) / omega, exponentially distributed with
/// rate omega, and is kept where t < -ln(1 - p), that is with probability 1 - (1 - p)^omega; for omega = 1 that is p again, and
/// the very same bonds. Bonds of weight 0 are never kept.
class BondOrder {
  public:
    /// `weights` is empty, or holds one number >= 0 per pair of the graph.
    BondOrder(const NeighbourGraph& graph, const std::vector<double>& weights, std::uint64_t seed);

    std::size_t size() const { return bonds_.size(); }
    const NeighbourPair& operator[](std::size_t n) const { return bonds_[n].pair; }

    /// How many of them are kept at probability p.
    std::size_t num_kept(double p) const;
    /// The probability at which so many are kept: their part of all bonds; with weights, the one that just keeps the last.
    double probability(std::size_t num_kept) const;
    bool weighted() const { return weighted_; }

  private:
    struct Bond {
        double arrival;  ///< u, or t where there are weights
        NeighbourPair pair;

        auto operator<=>(const Bond&) const = default;
    };

    bool weighted_;
    std::vector<Bond> bonds_;
};

/// Grains while bond after bond is kept.
struct BondSweepState {
    std::size_t num_kept = 0;
    std::size_t num_grains = 0;
    std::size_t largest = 0;      ///< sites of the largest grain
    double sum_of_squares = 0.0;  ///< of all grains' numbers of sites; exact to 2^53

    /// Mean, over the sites, of the size of the grain that a site is in, the largest grain counted as nothing.
    double mean_other_size(std::size_t num_visible) const {
        const double squared_largest = static_cast<double>(largest) * static_cast<double>(largest);
        return num_visible == 0 ? 0.0 : (sum_of_squares - squared_largest) / static_cast<double>(num_visible);
    }
};

/// Keeps bond after bond and calls `visit` with the state without bonds and after each of them: one sweep of M. E. J. Newman &
/// R. M. Ziff, "Fast Monte Carlo algorithm for site or bond percolation", Phys. Rev. E 64, 016706 (2001).
template <typename Visitor>
void sweep_bonds(const BondOrder& bonds, std::size_t num_sites, std::size_t num_visible, const Visitor& visit) {
    UnionFind clusters(num_sites);
    BondSweepState state;
    state.num_grains = num_visible;
    state.largest = num_visible > 0 ? 1 : 0;
    state.sum_of_squares = static_cast<double>(num_visible);
    visit(state);
    for (std::size_t n = 0; n < bonds.size(); ++n) {
        const std::size_t a = clusters.root(static_cast<std::size_t>(bonds[n].first));
        const std::size_t b = clusters.root(static_cast<std::size_t>(bonds[n].second));
        ++state.num_kept;
        if (a != b) {
            state.sum_of_squares += 2.0 * static_cast<double>(clusters.size_at(a)) * static_cast<double>(clusters.size_at(b));
            const std::size_t joined = clusters.join(a, b);
            if (joined > state.largest) state.largest = joined;
            --state.num_grains;
        }
        visit(state);
    }
}

/// Follows a sweep to its percolation threshold: the probability at which the mean size of the grains other than the largest
/// peaks.
class ThresholdFinder {
  public:
    void visit(const BondSweepState& state, std::size_t num_visible) {
        const double size = state.mean_other_size(num_visible);
        if (state.num_kept == 0 || !(size > highest_)) return;
        highest_ = size;
        num_kept_ = state.num_kept;
    }
    /// None where bonds never joined more than one grain.
    std::optional<double> threshold(const BondOrder& bonds) const {
        return num_kept_ == 0 ? std::nullopt : std::optional<double>(bonds.probability(num_kept_));
    }

  private:
    double highest_ = 0.0;
    std::size_t num_kept_ = 0;
};

}  // namespace opal
