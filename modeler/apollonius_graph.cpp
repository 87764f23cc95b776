// SPDX-License-Identifier: GPL-3.0-or-later
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "formats/command.h"
#include "modeler/neighbour_graph.h"
#include "modeler/site_culling.h"

namespace opal {
namespace {

using Metric = TessellationMetric<TessellationKind::additive>;

/// Blocks up to this many spacings wide are searched by one task, level by level: faces are met while blocks are large, and what
/// is known then need not be looked for again in smaller ones.
constexpr double task_size = 4.0;
/// Above this size (in spacings) blocks have too many candidates for pairs to be worth a test.
constexpr double largest_tested_size = 0.5;
constexpr int max_search_steps = 12;
/// How far (in block sizes) the search steps beyond the place where a rival is as near.
constexpr double lead_margin = 0.02;

struct Block {
    openvdb::Vec3d centre_mm;
    bool inside;                 ///< the shape contains all of it
    std::uint32_t first, count;  ///< candidates, as a range of the level's list
};

/// Blocks of one size with their candidates, one list for all.
struct Level {
    std::vector<Block> blocks;
    Candidates candidates;

    std::span<const std::int32_t> candidates_of(const Block& block) const {
        return {candidates.data() + block.first, block.count};
    }
};

class PairSet {
  public:
    bool has(std::int32_t a, std::int32_t b) const { return keys_.count(key(a, b)) != 0; }
    void add(std::int32_t a, std::int32_t b) { keys_.insert(key(a, b)); }
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

class FaceSearch {
  public:
    FaceSearch(const SiteCulling<Metric>& culling, const Shape& shape, double spacing_mm)
        : culling_(culling), shape_(shape), spacing_mm_(spacing_mm), tolerance_mm_(1.0e-9 * spacing_mm) {}

    /// Divides space until blocks are small enough for a task of their own.
    void visit(const openvdb::Vec3d& centre_mm, double size_mm, bool inside, std::span<const std::int32_t> from) {
        if (interrupt_requested()) return;
        Level level;
        if (!add_block(centre_mm, size_mm, inside, from, level)) return;
        if (size_mm <= task_size * spacing_mm_) {
            search(std::move(level), size_mm);
            return;
        }
        const bool child_inside = level.blocks.front().inside;
        tbb::parallel_for(0, 8, [&](int octant) {
            visit(child_centre(centre_mm, size_mm, octant), 0.5 * size_mm, child_inside, level.candidates);
        });
    }

    NeighbourGraph finish() {
        NeighbourGraph all;
        for (NeighbourGraph& part : found_) all.insert(all.end(), part.begin(), part.end());
        std::sort(all.begin(), all.end());
        all.erase(std::unique(all.begin(), all.end()), all.end());
        return all;
    }

  private:
    static openvdb::Vec3d child_centre(const openvdb::Vec3d& centre_mm, double size_mm, int octant) {
        const double step_mm = 0.25 * size_mm;
        return centre_mm + openvdb::Vec3d((octant & 4) ? step_mm : -step_mm, (octant & 2) ? step_mm : -step_mm,
                                          (octant & 1) ? step_mm : -step_mm);
    }

    /// False where no face can be: out of the shape, or all one cell's.
    bool add_block(const openvdb::Vec3d& centre_mm, double size_mm, bool inside, std::span<const std::int32_t> from,
                   Level& level) const {
        const double half_diagonal_mm = 0.5 * std::sqrt(3.0) * size_mm;
        const std::size_t first = level.candidates.size();
        culling_.shrink(from, centre_mm, half_diagonal_mm, level.candidates);
        const std::size_t count = level.candidates.size() - first;
        if (count >= 2 && !inside) {
            const double distance_mm = shape_.signed_distance_mm(centre_mm);
            if (distance_mm > half_diagonal_mm) {
                level.candidates.resize(first);
                return false;
            }
            inside = distance_mm < -half_diagonal_mm;
        }
        if (count < 2) {
            level.candidates.resize(first);
            return false;
        }
        level.blocks.push_back({centre_mm, inside, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)});
        return true;
    }

    void search(Level level, double size_mm) {
        PairSet known;
        while (!level.blocks.empty() && !interrupt_requested()) {
            Level next;
            const bool divisible = size_mm > smallest_face_search * spacing_mm_;
            for (const Block& block : level.blocks) {
                const std::span<const std::int32_t> candidates = level.candidates_of(block);
                const bool open = size_mm > largest_tested_size * spacing_mm_ || test_pairs(block, size_mm, candidates, known);
                if (!open || !divisible) continue;
                for (int octant = 0; octant < 8; ++octant)
                    add_block(child_centre(block.centre_mm, size_mm, octant), 0.5 * size_mm, block.inside, candidates, next);
            }
            level = std::move(next);
            size_mm *= 0.5;
        }
        known.append_to(found_.local());
    }

    /// Whether a pair of the block's candidates remains that is not known to meet.
    bool test_pairs(const Block& block, double size_mm, std::span<const std::int32_t> candidates, PairSet& known) const {
        bool open = false;
        for (std::size_t a = 0; a + 1 < candidates.size(); ++a)
            for (std::size_t b = a + 1; b < candidates.size(); ++b) {
                if (known.has(candidates[a], candidates[b])) continue;
                if (meet(block, size_mm, candidates, candidates[a], candidates[b]))
                    known.add(candidates[a], candidates[b]);
                else
                    open = true;
            }
        return open;
    }

    /// Looks for a proof in the block: from its centre, Newton's steps lead to the surface where both are equally near; where
    /// another site is nearer still, a step along that surface leads away from it.
    bool meet(const Block& block, double size_mm, std::span<const std::int32_t> candidates, std::int32_t a,
              std::int32_t b) const {
        const Site& site_a = site(a);
        const Site& site_b = site(b);
        const double reach_mm = 0.5 * size_mm;
        openvdb::Vec3d x = block.centre_mm;
        for (int step = 0; step < max_search_steps; ++step) {
            const openvdb::Vec3d from_a = (x - site_a.position_mm).unitSafe();
            const openvdb::Vec3d across = from_a - (x - site_b.position_mm).unitSafe();
            const double steepness = across.lengthSqr();
            if (!(steepness > 0.0)) return false;
            const double delta_a_mm = Metric::delta_mm(x, site_a);
            const double difference_mm = delta_a_mm - Metric::delta_mm(x, site_b);
            openvdb::Vec3d move = across * (-difference_mm / steepness);
            if (std::abs(difference_mm) <= tolerance_mm_) {
                const Rival rival = strongest_rival(x, candidates, a, b);
                const double lead_mm = rival.delta_mm - std::max(delta_a_mm, delta_a_mm - difference_mm);
                if (lead_mm > tolerance_mm_) return block.inside || shape_.signed_distance_mm(x) < 0.0;
                openvdb::Vec3d away = (x - site(rival.index).position_mm).unitSafe() - from_a;
                away -= across * (away.dot(across) / steepness);
                if (!(away.lengthSqr() > 0.0)) return false;
                move = away * ((lead_margin * size_mm - lead_mm) / away.lengthSqr());
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
    tbb::enumerable_thread_specific<NeighbourGraph> found_;
};

}  // namespace

NeighbourGraph apollonius_graph(const std::vector<Site>& sites, const std::vector<char>& hidden, const Shape& shape,
                                double spacing_mm) {
    Candidates visible;
    for (std::size_t n = 0; n < sites.size(); ++n)
        if (hidden[n] == 0) visible.push_back(static_cast<std::int32_t>(n));
    const openvdb::BBoxd bounds_mm = shape.bounds_mm();
    const openvdb::Vec3d extents_mm = bounds_mm.extents();
    const SiteCulling<Metric> culling(sites, bounds_mm);
    FaceSearch search(culling, shape, spacing_mm);
    search.visit(bounds_mm.getCenter(), std::max({extents_mm.x(), extents_mm.y(), extents_mm.z()}), false, visible);
    throw_if_interrupted();
    return search.finish();
}

}  // namespace opal
