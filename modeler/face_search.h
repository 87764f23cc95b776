// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_set>
#include <vector>

#include "formats/command.h"
#include "modeler/neighbour_graph.h"
#include "modeler/site_culling.h"

namespace opal {

/// Pairs of sites found to share a face.
class PairSet {
  public:
    bool has(std::int32_t a, std::int32_t b) const { return keys_.count(key(a, b)) != 0; }
    void add(std::int32_t a, std::int32_t b) { keys_.insert(key(a, b)); }
    bool empty() const { return keys_.empty(); }
    void append_to(NeighbourGraph& graph) const {
        for (const std::uint64_t k : keys_)
            graph.push_back({static_cast<std::int32_t>(k >> 32), static_cast<std::int32_t>(k & 0xFFFFFFFFu)});
    }

  private:
    /// Candidate lists ascend, so a < b always.
    static std::uint64_t key(std::int32_t a, std::int32_t b) {
        return (static_cast<std::uint64_t>(a) << 32) | static_cast<std::uint64_t>(static_cast<std::uint32_t>(b));
    }
    std::unordered_set<std::uint64_t> keys_;
};

/// Looks for shared faces by dividing space, in the metric of any tessellation. Cubes are divided with candidate lists that
/// shrink on the way (SiteCulling), as long as they hold a pair of candidates that is asked for and not known to meet, down to
/// `smallest_face_search` spacings. A pair is taken only on proof: a point of the cube, inside the shape, where both sites are
/// equally near and every other candidate is farther.
///
/// Which pairs are asked for is up to `Wanted`: `pair(a, b)` says so for one, a < b; `any(candidates)` is false for a list that
/// holds none.
template <typename Metric, typename Wanted>
class FaceSearch {
  public:
    /// `cubes_looked_at`: counts them; may be null.
    FaceSearch(const SiteCulling<Metric>& culling, const Shape& shape, double spacing_mm, const Wanted& wanted,
               std::atomic<std::uint64_t>* cubes_looked_at)
        : culling_(culling),
          shape_(shape),
          spacing_mm_(spacing_mm),
          tolerance_mm_(1.0e-9 * spacing_mm),
          wanted_(wanted),
          cubes_looked_at_(cubes_looked_at) {}

    /// Searches the cube; `from` holds all sites that may own a point of it. Hands a PairSet per task to `sink`, which several
    /// threads may call at once.
    template <typename Sink>
    void search_in_parallel(const openvdb::Vec3d& centre_mm, double size_mm, bool inside, std::span<const std::int32_t> from,
                            const Sink& sink) const {
        if (interrupt_requested()) return;
        Level level;
        count_cubes(1);
        if (!add_block(centre_mm, size_mm, inside, from, level)) return;
        if (size_mm <= task_size * spacing_mm_) {
            PairSet known;
            search(std::move(level), size_mm, known);
            if (!known.empty()) sink(known);
            return;
        }
        const bool child_inside = level.blocks.front().inside;
        tbb::parallel_for(0, 8, [&](int octant) {
            search_in_parallel(child_centre(centre_mm, size_mm, octant), 0.5 * size_mm, child_inside, level.candidates, sink);
        });
    }

    /// The same in this thread alone, for a small cube.
    void search(const openvdb::Vec3d& centre_mm, double size_mm, std::span<const std::int32_t> from, PairSet& known) const {
        Level level;
        count_cubes(1);
        if (add_block(centre_mm, size_mm, false, from, level)) search(std::move(level), size_mm, known);
    }

  private:
    /// Cubes up to this many spacings wide are searched by one task, level by level: faces are met while cubes are large, and
    /// what is known then need not be looked for again in smaller ones.
    static constexpr double task_size = 4.0;
    /// Above this size (in spacings) cubes have too many candidates for pairs to be worth a test.
    static constexpr double largest_tested_size = 0.5;
    static constexpr int max_search_steps = 12;
    /// How far (in cube sizes) the search steps beyond the place where a rival is as near.
    static constexpr double lead_margin = 0.02;

    struct Block {
        openvdb::Vec3d centre_mm;
        bool inside;                 ///< the shape contains all of it
        std::uint32_t first, count;  ///< candidates, as a range of the level's list
    };

    /// Cubes of one size with their candidates, one list for all.
    struct Level {
        std::vector<Block> blocks;
        Candidates candidates;

        std::span<const std::int32_t> candidates_of(const Block& block) const {
            return {candidates.data() + block.first, block.count};
        }
    };

    static openvdb::Vec3d child_centre(const openvdb::Vec3d& centre_mm, double size_mm, int octant) {
        const double step_mm = 0.25 * size_mm;
        return centre_mm + openvdb::Vec3d((octant & 4) ? step_mm : -step_mm, (octant & 2) ? step_mm : -step_mm,
                                          (octant & 1) ? step_mm : -step_mm);
    }

    void count_cubes(std::uint64_t number) const {
        if (cubes_looked_at_) cubes_looked_at_->fetch_add(number, std::memory_order_relaxed);
    }

    /// False where no face that is asked for can be: out of the shape, or of other cells.
    bool add_block(const openvdb::Vec3d& centre_mm, double size_mm, bool inside, std::span<const std::int32_t> from,
                   Level& level) const {
        const double half_diagonal_mm = 0.5 * std::sqrt(3.0) * size_mm;
        const std::size_t first = level.candidates.size();
        culling_.shrink(from, centre_mm, half_diagonal_mm, level.candidates);
        culling_.compare_with_nearest(first, centre_mm, half_diagonal_mm, level.candidates);
        const std::size_t count = level.candidates.size() - first;
        bool needed = wanted_.any(std::span<const std::int32_t>(level.candidates.data() + first, count));
        if (needed && !inside) {
            const double distance_mm = shape_.signed_distance_mm(centre_mm);
            needed = distance_mm <= half_diagonal_mm;
            inside = distance_mm < -half_diagonal_mm;
        }
        if (needed)
            level.blocks.push_back({centre_mm, inside, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)});
        else
            level.candidates.resize(first);
        return needed;
    }

    void search(Level level, double size_mm, PairSet& known) const {
        while (!level.blocks.empty() && !interrupt_requested()) {
            Level next;
            std::uint64_t divided = 0;
            const bool divisible = size_mm > smallest_face_search * spacing_mm_;
            for (const Block& block : level.blocks) {
                const std::span<const std::int32_t> candidates = level.candidates_of(block);
                const bool open = size_mm > largest_tested_size * spacing_mm_ || test_pairs(block, size_mm, candidates, known);
                if (!open || !divisible) continue;
                ++divided;
                for (int octant = 0; octant < 8; ++octant)
                    add_block(child_centre(block.centre_mm, size_mm, octant), 0.5 * size_mm, block.inside, candidates, next);
            }
            count_cubes(8 * divided);
            level = std::move(next);
            size_mm *= 0.5;
        }
    }

    /// Whether a pair of the cube's candidates remains that is asked for and not known to meet.
    bool test_pairs(const Block& block, double size_mm, std::span<const std::int32_t> candidates, PairSet& known) const {
        bool open = false;
        for (std::size_t a = 0; a + 1 < candidates.size(); ++a)
            for (std::size_t b = a + 1; b < candidates.size(); ++b) {
                if (!wanted_.pair(candidates[a], candidates[b]) || known.has(candidates[a], candidates[b])) continue;
                if (meet(block, size_mm, candidates, candidates[a], candidates[b]))
                    known.add(candidates[a], candidates[b]);
                else
                    open = true;
            }
        return open;
    }

    /// Looks for a proof in the cube: from its centre, Newton's steps lead to the surface where both are equally near; where
    /// another site is nearer still, a step along that surface leads away from it.
    bool meet(const Block& block, double size_mm, std::span<const std::int32_t> candidates, std::int32_t a,
              std::int32_t b) const {
        const Site& site_a = site(a);
        const Site& site_b = site(b);
        const double reach_mm = 0.5 * size_mm;
        const double slope = Metric::slope(site_a);
        openvdb::Vec3d x = block.centre_mm;
        for (int step = 0; step < max_search_steps; ++step) {
            const openvdb::Vec3d from_a = Metric::gradient(x, site_a);
            const openvdb::Vec3d across = from_a - Metric::gradient(x, site_b);
            const double steepness = across.lengthSqr();
            if (!(steepness > 0.0)) return false;
            const double delta_a_mm = Metric::delta_mm(x, site_a);
            const double difference_mm = delta_a_mm - Metric::delta_mm(x, site_b);
            openvdb::Vec3d move = across * (-difference_mm / steepness);
            if (std::abs(difference_mm) <= tolerance_mm_ * slope) {
                const Rival rival = strongest_rival(x, candidates, a, b);
                const double lead_mm = rival.delta_mm - std::max(delta_a_mm, delta_a_mm - difference_mm);
                if (lead_mm > tolerance_mm_ * slope) return block.inside || shape_.contains(x);
                openvdb::Vec3d away = Metric::gradient(x, site(rival.index)) - from_a;
                away -= across * (away.dot(across) / steepness);
                if (!(away.lengthSqr() > 0.0)) return false;
                move = away * ((lead_margin * size_mm * slope - lead_mm) / away.lengthSqr());
            }
            x += move;
            for (int axis = 0; axis < 3; ++axis)
                if (!(std::abs(x[axis] - block.centre_mm[axis]) <= reach_mm)) return false;
        }
        return false;
    }

    struct Rival {
        std::int32_t index;
        double delta_mm;
    };

    /// The nearest of the other candidates.
    Rival strongest_rival(const openvdb::Vec3d& x, std::span<const std::int32_t> candidates, std::int32_t a,
                          std::int32_t b) const {
        Rival rival{a, std::numeric_limits<double>::infinity()};
        for (const std::int32_t c : candidates) {
            if (c == a || c == b) continue;
            const double delta_mm = Metric::delta_mm(x, site(c));
            if (delta_mm < rival.delta_mm) rival = {c, delta_mm};
        }
        return rival;
    }

    const Site& site(std::int32_t index) const { return culling_.sites()[static_cast<std::size_t>(index)]; }

    const SiteCulling<Metric>& culling_;
    const Shape& shape_;
    double spacing_mm_;
    double tolerance_mm_;
    const Wanted& wanted_;
    std::atomic<std::uint64_t>* cubes_looked_at_;
};

}  // namespace opal
