// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/sample_elimination.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>

#include "formats/command.h"
#include "modeler/sample_cells.h"

namespace opal {
namespace {

/// Crowding in fixed point: sums of integers do not depend on the order of their terms.
using FixedPoint = std::int64_t;
constexpr FixedPoint eliminated = -1;
constexpr FixedPoint not_gone = -1;

/// What neighbours at a distance add to each other's crowding.
class Crowding {
  public:
    Crowding(std::size_t samples, std::size_t target, double reach) : reach_(reach) {
        const double kept = static_cast<double>(target) / static_cast<double>(samples);
        nearest_ = 0.65 * (1.0 - std::pow(kept, 1.5));
        // Even all samples in one place do not overflow.
        scale_ = 0x1p62 / (power8(1.0 - nearest_) * static_cast<double>(samples));
    }

    FixedPoint operator()(double squared_distance) const {
        const double distance = std::max(nearest_, std::sqrt(squared_distance) / reach_);
        return static_cast<FixedPoint>(scale_ * power8(std::max(0.0, 1.0 - distance)));
    }

  private:
    static double power8(double x) {
        const double power2 = x * x;
        const double power4 = power2 * power2;
        return power4 * power4;
    }

    double reach_;
    double nearest_;  ///< in units of the reach
    double scale_;
};

/// Who is in whose reach: a list of places for each.
class NeighbourLists {
  public:
    explicit NeighbourLists(const SampleCells& cells)
        : end_(cells.size()), chunks_((cells.size() + chunk_size - 1) / chunk_size) {
        tbb::parallel_for(std::size_t(0), chunks_.size(), [&](std::size_t chunk) {
            std::vector<std::uint32_t> places;
            const std::size_t end = std::min(cells.size(), (chunk + 1) * chunk_size);
            for (std::size_t n = chunk * chunk_size; n < end; ++n) {
                cells.for_each_neighbour(n,
                                         [&](std::size_t other, double) { places.push_back(static_cast<std::uint32_t>(other)); });
                end_[n] = static_cast<std::uint32_t>(places.size());
            }
            chunks_[chunk].assign(places.begin(), places.end());
        });
    }

    std::span<const std::uint32_t> of(std::size_t place) const {
        const std::size_t begin = place % chunk_size == 0 ? 0 : end_[place - 1];
        return {chunks_[place / chunk_size].data() + begin, end_[place] - begin};
    }

  private:
    static constexpr std::size_t chunk_size = 1024;
    std::vector<std::uint32_t> end_;  ///< of each list in its chunk
    std::vector<std::vector<std::uint32_t>> chunks_;
};

/// Places that one thread works on; their neighbours are in no other slab's reach.
struct Slab {
    std::size_t begin, end;
};

/// Slabs of about equal numbers of samples, one per thread where there are planes enough.
std::vector<Slab> divide(const SampleCells& cells) {
    constexpr std::size_t fewest_planes = 8;
    const auto num_slabs =
        std::min(static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()), cells.num_planes() / fewest_planes);
    std::vector<Slab> slabs;
    std::size_t plane = 0;
    for (std::size_t n = 1; n <= num_slabs; ++n) {
        const std::size_t first = plane;
        while (plane < cells.num_planes() && cells.plane_begin(plane) < n * cells.size() / num_slabs) ++plane;
        if (plane > first + 2) slabs.push_back({cells.plane_begin(first + 1), cells.plane_begin(plane - 1)});
    }
    return slabs;
}

/// The elimination proper, on samples in the order of their cells.
///
/// Among neighbours the more crowded sample always goes first: a sample that is more crowded than all of its neighbours stays so
/// until it goes itself, since crowding only falls. How samples out of each other's reach take turns therefore changes nothing:
/// neither who goes nor how crowded it was then. So no queue over all samples is needed: the search climbs from sample to more
/// crowded neighbour and takes the summit, works through space cell by cell, in cached memory, and in several slabs at once.
class Elimination {
  public:
    Elimination(const SampleCells& cells, std::size_t target)
        : cells_(cells),
          neighbours_(cells),
          crowding_(cells.size(), target, cells.reach()),
          weight_(cells.size()),
          weight_when_gone_(cells.size(), not_gone),
          slabs_(divide(cells)) {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cells.size()), [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t n = range.begin(); n != range.end(); ++n)
                for (const std::uint32_t other : neighbours_.of(n)) weight_[n] += crowding_(cells_.squared_distance(n, other));
        });
    }

    FixedPoint highest_weight() const { return *std::max_element(weight_.begin(), weight_.end()); }

    /// Eliminates whoever is more crowded than the limit when the turn comes; returns how many are left.
    std::size_t eliminate_above(FixedPoint limit) {
        tbb::parallel_for(std::size_t(0), slabs_.size(), [&](std::size_t n) { eliminate_in(slabs_[n], limit); });
        // Whoever was blocked by a neighbour in another slab.
        eliminate_in({0, weight_.size()}, limit);
        return weight_.size() - static_cast<std::size_t>(std::count(weight_.begin(), weight_.end(), eliminated));
    }

    /// The `count` samples that one queue would have left: who is still here, and of the others who went last.
    std::vector<std::size_t> last_to_go(std::size_t count) const {
        std::vector<std::size_t> order(weight_.size());
        std::iota(order.begin(), order.end(), std::size_t(0));
        const auto outlives = [&](std::size_t a, std::size_t b) {
            return weight_when_gone_[a] != weight_when_gone_[b] ? weight_when_gone_[a] < weight_when_gone_[b]
                                                                : cells_.index(a) > cells_.index(b);
        };
        std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(), outlives);
        order.resize(count);
        return order;
    }

  private:
    bool goes_before(std::size_t a, std::size_t b) const {
        return weight_[a] != weight_[b] ? weight_[a] > weight_[b] : cells_.index(a) < cells_.index(b);
    }

    void eliminate_in(const Slab& slab, FixedPoint limit) {
        std::vector<std::size_t> path;
        for (std::size_t place = slab.begin; place < slab.end && !interrupt_requested(); ++place)
            while (weight_[place] > limit && climb_from(place, slab, limit, path)) continue;
        throw_if_interrupted();
    }

    /// Eliminates `start`, after all that must go before; false where one of these is not in the slab. `path` is working memory:
    /// the climb, each sample more crowded than the one before.
    bool climb_from(std::size_t start, const Slab& slab, FixedPoint limit, std::vector<std::size_t>& path) {
        path.assign(1, start);
        while (!path.empty()) {
            const std::size_t top = path.back();
            if (top < slab.begin || top >= slab.end) return false;
            const auto neighbours = neighbours_.of(top);
            const auto higher =
                std::find_if(neighbours.begin(), neighbours.end(), [&](std::size_t other) { return goes_before(other, top); });
            if (higher != neighbours.end()) {
                path.push_back(*higher);
                continue;
            }
            eliminate(top);
            do path.pop_back();
            while (!path.empty() && weight_[path.back()] <= limit);
        }
        return true;
    }

    void eliminate(std::size_t place) {
        weight_when_gone_[place] = weight_[place];
        weight_[place] = eliminated;
        for (const std::uint32_t other : neighbours_.of(place))
            if (weight_[other] != eliminated) weight_[other] -= crowding_(cells_.squared_distance(place, other));
    }

    const SampleCells& cells_;
    NeighbourLists neighbours_;
    Crowding crowding_;
    std::vector<FixedPoint> weight_;
    std::vector<FixedPoint> weight_when_gone_;
    std::vector<Slab> slabs_;
};

}  // namespace

double packing_radius(double volume, std::size_t count) {
    return std::cbrt(volume / (4.0 * std::sqrt(2.0) * static_cast<double>(count)));
}

std::vector<std::size_t> eliminate_samples(const std::vector<openvdb::Vec3d>& samples, std::size_t target, double r_max) {
    std::vector<std::size_t> survivors;
    if (samples.size() <= target) {
        survivors.resize(samples.size());
        std::iota(survivors.begin(), survivors.end(), std::size_t(0));
        return survivors;
    }
    const SampleCells cells(samples, 2.0 * r_max);
    Elimination elimination(cells, target);
    // Whoever is eliminated beyond the target comes back; limits that fall slowly keep these few, and climbs short.
    FixedPoint limit = elimination.highest_weight();
    do limit -= (limit + 3) / 4;
    while (elimination.eliminate_above(limit) > target && limit > 0);
    for (const std::size_t place : elimination.last_to_go(target)) survivors.push_back(cells.index(place));
    std::sort(survivors.begin(), survivors.end());
    return survivors;
}

}  // namespace opal
