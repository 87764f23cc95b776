// SPDX-License-Identifier: Apache-2.0
#include "periodic_graph.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "modeler/bond_order.h"
#include "modeler_test_tools.h"

namespace opal::testing_tools {
namespace {

struct CrossingPair {
    NeighbourPair pair;
    openvdb::Coord crossing;

    bool operator<(const CrossingPair& other) const { return pair < other.pair; }
};

PeriodicGraph sorted_graph(std::size_t num_sites, std::vector<CrossingPair> pairs) {
    std::sort(pairs.begin(), pairs.end());
    PeriodicGraph graph{num_sites, {}, {}};
    for (const CrossingPair& each : pairs) {
        graph.pairs.push_back(each.pair);
        graph.crossing.push_back(each.crossing);
    }
    return graph;
}

/// Disjoint sets that know in which copy of the cube each member lies, as seen from its set's root.
class WindingSets {
  public:
    explicit WindingSets(std::size_t count) : parent_(count), copy_(count, openvdb::Coord(0)), size_(count, 1) {
        std::iota(parent_.begin(), parent_.end(), std::size_t(0));
    }

    /// Adds a bond; returns how often the path that it closes winds around the cube.
    openvdb::Coord join(std::size_t a, std::size_t b, const openvdb::Coord& crossing) {
        const auto [root_a, copy_a] = find(a);
        const auto [root_b, copy_b] = find(b);
        const openvdb::Coord step = copy_a + crossing - copy_b;  // root b's copy as seen from root a
        if (root_a == root_b) return step;
        const bool a_stays = size_[root_a] >= size_[root_b];
        const std::size_t kept = a_stays ? root_a : root_b, moved = a_stays ? root_b : root_a;
        parent_[moved] = kept;
        copy_[moved] = a_stays ? step : openvdb::Coord(0) - step;
        size_[kept] += size_[moved];
        return openvdb::Coord(0);
    }

  private:
    std::pair<std::size_t, openvdb::Coord> find(std::size_t element) const {
        openvdb::Coord copy(0);
        for (; parent_[element] != element; element = parent_[element]) copy += copy_[element];
        return {element, copy};
    }

    std::vector<std::size_t> parent_;
    std::vector<openvdb::Coord> copy_;  ///< relative to the parent's
    std::vector<std::size_t> size_;
};

}  // namespace

PeriodicGraph periodic_poisson_delaunay(std::size_t num_sites, std::uint64_t seed) {
    const double depth = 4.0 / std::cbrt(double(num_sites));
    std::vector<Site> sites = random_sites(openvdb::BBoxd(openvdb::Vec3d(0.0), openvdb::Vec3d(1.0)), num_sites, 0.0, seed);
    std::vector<std::int32_t> original(num_sites);
    std::iota(original.begin(), original.end(), 0);
    std::vector<openvdb::Coord> copy(num_sites, openvdb::Coord(0));
    for (const openvdb::Coord& offset : openvdb::CoordBBox(openvdb::Coord(-1), openvdb::Coord(1))) {
        if (offset == openvdb::Coord(0)) continue;
        for (std::size_t n = 0; n < num_sites; ++n) {
            const openvdb::Vec3d place = sites[n].position_mm + offset.asVec3d();
            bool near = true;
            for (int axis = 0; axis < 3; ++axis) near = near && place[axis] > -depth && place[axis] < 1.0 + depth;
            if (!near) continue;
            sites.push_back({place, 0.0f, 0});
            original.push_back(std::int32_t(n));
            copy.push_back(offset);
        }
    }
    std::vector<CrossingPair> pairs;
    for (const NeighbourPair& edge : delaunay_graph(sites, std::vector<char>(sites.size(), 0))) {
        const auto a = std::size_t(edge.first), b = std::size_t(edge.second);
        if (a >= num_sites) continue;
        // A bond across a face appears twice, once from either end: the end with the lower site counts.
        if (original[a] < original[b]) pairs.push_back({{original[a], original[b]}, copy[b]});
    }
    return sorted_graph(num_sites, std::move(pairs));
}

PeriodicGraph periodic_cubic_lattice(std::int32_t n) {
    std::vector<CrossingPair> pairs;
    const auto number = [n](const openvdb::Coord& cell) { return (cell.x() * n + cell.y()) * n + cell.z(); };
    for (const openvdb::Coord& cell : openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(n - 1)))
        for (int axis = 0; axis < 3; ++axis) {
            openvdb::Coord next = cell, crossing(0);
            if (++next[axis] == n) {
                next[axis] = 0;
                crossing[axis] = 1;
            }
            if (number(cell) < number(next))
                pairs.push_back({{number(cell), number(next)}, crossing});
            else
                pairs.push_back({{number(next), number(cell)}, openvdb::Coord(0) - crossing});
        }
    return sorted_graph(std::size_t(n) * std::size_t(n) * std::size_t(n), std::move(pairs));
}

openvdb::Vec3d winding_probabilities(const PeriodicGraph& graph, std::uint64_t seed) {
    const BondOrder bonds(graph.pairs, {}, seed);
    WindingSets clusters(graph.num_sites);
    openvdb::Vec3d first(0.0);
    for (std::size_t n = 0; n < bonds.size() && first[0] * first[1] * first[2] == 0.0; ++n) {
        const auto place = std::lower_bound(graph.pairs.begin(), graph.pairs.end(), bonds[n]) - graph.pairs.begin();
        const openvdb::Coord winds =
            clusters.join(std::size_t(bonds[n].first), std::size_t(bonds[n].second), graph.crossing[std::size_t(place)]);
        for (int axis = 0; axis < 3; ++axis)
            if (winds[axis] != 0 && first[axis] == 0.0) first[axis] = bonds.probability(n + 1);
    }
    return first;
}

ThresholdEstimate estimate_threshold(const PeriodicGraph& graph, int sweeps) {
    constexpr double winding_at_threshold = 0.2578;
    std::vector<double> p;
    double sum = 0.0, squares = 0.0;
    for (int seed = 1; seed <= sweeps; ++seed) {
        const openvdb::Vec3d first = winding_probabilities(graph, std::uint64_t(seed));
        for (int axis = 0; axis < 3; ++axis) {
            p.push_back(first[axis]);
            sum += first[axis];
            squares += first[axis] * first[axis];
        }
    }
    std::sort(p.begin(), p.end());
    const double count = double(p.size()), rank = winding_at_threshold * count - 0.5;
    const auto below = std::size_t(rank);
    const double mean = sum / count, std = std::sqrt(squares / count - mean * mean);
    // Of a quantile q: sqrt(q (1 - q) / draws) / density, the density that of a normal distribution there, 0.323 / std.
    const double error = std::sqrt(winding_at_threshold * (1.0 - winding_at_threshold) / sweeps) * std / 0.323;
    return {p[below] + (rank - double(below)) * (p[below + 1] - p[below]), error};
}

}  // namespace opal::testing_tools
