// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/bond_order.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>

#include "formats/random.h"

namespace opal {

BondOrder::BondOrder(const NeighbourGraph& graph, const std::vector<double>& weights, std::uint64_t seed)
    : weighted_(!weights.empty()), bonds_(graph.size()) {
    tbb::parallel_for(std::size_t(0), graph.size(), [&](std::size_t n) {
        const NeighbourPair& pair = graph[n];
        const std::uint64_t index =
            (static_cast<std::uint64_t>(pair.first) << 32) | static_cast<std::uint64_t>(static_cast<std::uint32_t>(pair.second));
        const RandomBlock block = random_block(seed, RandomStream::sintering_bonds, index, 0);
        const double u = uniform_double(block.value[0], block.value[1]);
        bonds_[n] = {weighted_ ? -std::log1p(-u) / weights[n] : u, pair};
    });
    // A weight of 0 arrives at infinity, or nowhere (0 / 0).
    std::erase_if(bonds_, [](const Bond& bond) { return !std::isfinite(bond.arrival); });
    tbb::parallel_sort(bonds_.begin(), bonds_.end());
}

std::size_t BondOrder::num_kept(double p) const {
    const double limit = weighted_ ? -std::log1p(-p) : p;
    const auto end = std::partition_point(bonds_.begin(), bonds_.end(), [&](const Bond& bond) { return bond.arrival < limit; });
    return static_cast<std::size_t>(end - bonds_.begin());
}

double BondOrder::probability(std::size_t num_kept) const {
    if (num_kept == 0) return 0.0;
    if (weighted_) return -std::expm1(-bonds_[num_kept - 1].arrival);
    return static_cast<double>(num_kept) / static_cast<double>(bonds_.size());
}

}  // namespace opal
