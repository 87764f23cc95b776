// SPDX-License-Identifier: GPL-3.0-or-later
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "formats/command.h"
#include "modeler/face_search.h"
#include "modeler/neighbour_graph.h"
#include "modeler/radial_cell.h"
#include "modeler/site_culling.h"

namespace opal {
namespace {

using AdditiveMetric = TessellationMetric<TessellationKind::additive>;

/// Sites of cubes up to this many spacings wide share one list of rivals.
constexpr double shared_cube_size = 2.0;
/// Cells are followed this many spacings far from their site.
constexpr double cell_reach = 1.25;

struct AllPairs {
    static bool pair(std::int32_t, std::int32_t) { return true; }
    static bool any(std::span<const std::int32_t> candidates) { return candidates.size() >= 2; }
};

/// Pairs of one site with some others.
struct PairsOfSite {
    std::int32_t site;
    const std::vector<std::int32_t>& others;  ///< ascending

    bool is_other(std::int32_t index) const { return std::binary_search(others.begin(), others.end(), index); }
    bool pair(std::int32_t a, std::int32_t b) const { return a == site ? is_other(b) : b == site && is_other(a); }
    bool any(std::span<const std::int32_t> candidates) const {
        return std::binary_search(candidates.begin(), candidates.end(), site) &&
               std::any_of(candidates.begin(), candidates.end(), [this](std::int32_t index) { return is_other(index); });
    }
};

/// Pairs of marked sites that are not found yet.
struct PairsOfMarked {
    const std::vector<char>& marked;
    const std::vector<std::vector<std::int32_t>>& found;  ///< of each site, ascending

    bool is_marked(std::int32_t index) const { return marked[static_cast<std::size_t>(index)] != 0; }
    bool has_found(std::int32_t site, std::int32_t other) const {
        const std::vector<std::int32_t>& others = found[static_cast<std::size_t>(site)];
        return std::binary_search(others.begin(), others.end(), other);
    }
    bool pair(std::int32_t a, std::int32_t b) const {
        return is_marked(a) && is_marked(b) && !has_found(a, b) && !has_found(b, a);
    }
    bool any(std::span<const std::int32_t> candidates) const {
        return std::count_if(candidates.begin(), candidates.end(), [this](std::int32_t index) { return is_marked(index); }) >= 2;
    }
};

struct Cube {
    openvdb::Vec3d centre_mm;
    double size_mm;

    double half_diagonal_mm() const { return 0.5 * std::sqrt(3.0) * size_mm; }
    int octant_of(const openvdb::Vec3d& point_mm) const {
        return (point_mm.x() >= centre_mm.x() ? 4 : 0) + (point_mm.y() >= centre_mm.y() ? 2 : 0) +
               (point_mm.z() >= centre_mm.z() ? 1 : 0);
    }
    Cube child(int octant) const {
        const double step_mm = 0.25 * size_mm;
        return {centre_mm + openvdb::Vec3d((octant & 4) ? step_mm : -step_mm, (octant & 2) ? step_mm : -step_mm,
                                           (octant & 1) ? step_mm : -step_mm),
                0.5 * size_mm};
    }
};

/// A cube around all that is in either, with room on all sides.
Cube cube_around(openvdb::BBoxd bounds_mm, const std::vector<Site>& sites, std::span<const std::int32_t> visible,
                 double room_mm) {
    for (const std::int32_t n : visible) bounds_mm.expand(sites[static_cast<std::size_t>(n)].position_mm);
    const openvdb::Vec3d extents_mm = bounds_mm.extents();
    return {bounds_mm.getCenter(), std::max({extents_mm.x(), extents_mm.y(), extents_mm.z()}) + 2.0 * room_mm};
}

openvdb::BBoxd box_of(const Cube& cube) {
    return {cube.centre_mm - openvdb::Vec3d(0.5 * cube.size_mm), cube.centre_mm + openvdb::Vec3d(0.5 * cube.size_mm)};
}

/// Cell by cell: most pairs are settled by the radial view of one of their cells. What that leaves undecided is searched for near
/// the cell. Cells that it does not see the end of, most of them at the shape's surface, are left to a search through all of
/// space, for neighbours among themselves.
class CellByCell {
  public:
    CellByCell(const std::vector<Site>& sites, const std::vector<std::int32_t>& visible, const Shape& shape, double spacing_mm,
               std::atomic<std::uint64_t>* cubes_looked_at)
        : sites_(sites),
          shape_(shape),
          spacing_mm_(spacing_mm),
          cubes_looked_at_(cubes_looked_at),
          reach_mm_(cell_reach * spacing_mm * std::cbrt(static_cast<double>(sites.size()) / static_cast<double>(visible.size()))),
          space_(cube_around(shape.bounds_mm(), sites, visible, 0.0)),
          culling_(sites, box_of({space_.centre_mm, space_.size_mm + 4.0 * reach_mm_})),
          found_(sites.size()),
          unbounded_(sites.size(), 0) {
        Candidates members = visible;
        visit(space_, members, visible);
        throw_if_interrupted();
    }

    NeighbourGraph finish(const std::vector<std::int32_t>& visible) {
        search_among_unbounded(visible);
        throw_if_interrupted();
        return collect();
    }

  private:
    /// `members` are the sites in the cube, `rivals` those that may own a point within the reach of one in it.
    void visit(const Cube& cube, std::span<std::int32_t> members, std::span<const std::int32_t> from) {
        if (members.empty() || interrupt_requested()) return;
        Candidates rivals;
        culling_.shrink(from, cube.centre_mm, cube.half_diagonal_mm() + reach_mm_, rivals);
        if (cube.size_mm <= shared_cube_size * spacing_mm_) {
            find_faces(members, rivals);
            return;
        }
        std::array<std::span<std::int32_t>, 8> parts;
        std::span<std::int32_t> rest = members;
        for (int octant = 0; octant < 8; ++octant) {
            const auto end = std::stable_partition(rest.begin(), rest.end(), [&](std::int32_t n) {
                return cube.octant_of(sites_[static_cast<std::size_t>(n)].position_mm) == octant;
            });
            const auto count = static_cast<std::size_t>(end - rest.begin());
            parts[static_cast<std::size_t>(octant)] = rest.first(count);
            rest = rest.subspan(count);
        }
        tbb::parallel_for(0, 8, [&](int octant) { visit(cube.child(octant), parts[static_cast<std::size_t>(octant)], rivals); });
    }

    void find_faces(std::span<const std::int32_t> members, const Candidates& rivals) {
        Workspace& work = workspaces_.local();
        work.block.assign(sites_, rivals);
        for (const std::int32_t site : members) settle(site, work);
    }

    struct Workspace {
        explicit Workspace(double tolerance_mm) : cell(tolerance_mm) {}
        SiteBlock block;
        RadialCell cell;
        std::vector<std::int32_t> undecided;
        Candidates rivals;
    };

    void settle(std::int32_t index, Workspace& work) {
        const Site& site = sites_[static_cast<std::size_t>(index)];
        const RadialCell::Faces& faces = work.cell.find_faces(site, index, work.block, reach_mm_);
        const double depth_mm = -shape_.signed_distance_mm(site.position_mm);
        std::vector<std::int32_t>& neighbours = found_[static_cast<std::size_t>(index)];
        unbounded_[static_cast<std::size_t>(index)] = faces.bounded ? 0 : 1;
        if (faces.bounded && depth_mm < -reach_mm_) return;
        work.undecided = faces.undecided;
        for (const RadialCell::Face& face : faces.proven) {
            if (depth_mm > reach_mm_ || shape_.contains(face.point_mm))
                neighbours.push_back(face.site);
            else
                work.undecided.push_back(face.site);
        }
        if (faces.bounded && !work.undecided.empty()) search_near(index, work, neighbours);
        std::sort(neighbours.begin(), neighbours.end());
    }

    void search_near(std::int32_t index, Workspace& work, std::vector<std::int32_t>& neighbours) const {
        std::sort(work.undecided.begin(), work.undecided.end());
        const std::span<const std::int32_t> rivals = work.cell.rivals();
        work.rivals.assign(rivals.begin(), rivals.end());
        work.rivals.push_back(index);
        std::sort(work.rivals.begin(), work.rivals.end());
        const PairsOfSite wanted{index, work.undecided};
        PairSet known;
        FaceSearch(culling_, shape_, spacing_mm_, wanted, cubes_looked_at_)
            .search(sites_[static_cast<std::size_t>(index)].position_mm, 2.0 * reach_mm_, work.rivals, known);
        NeighbourGraph pairs;
        known.append_to(pairs);
        for (const NeighbourPair& pair : pairs) neighbours.push_back(pair.first == index ? pair.second : pair.first);
    }

    void search_among_unbounded(const std::vector<std::int32_t>& visible) {
        const PairsOfMarked wanted{unbounded_, found_};
        FaceSearch(culling_, shape_, spacing_mm_, wanted, cubes_looked_at_)
            .search_in_parallel(space_.centre_mm, space_.size_mm, false, visible,
                                [this](const PairSet& known) { known.append_to(others_.local()); });
    }

    NeighbourGraph collect() {
        // Each pair from its lower site's list, or from its higher site's where only that has it.
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, found_.size()), [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t n = range.begin(); n != range.end(); ++n)
                for (const std::int32_t other : found_[n]) {
                    if (static_cast<std::size_t>(other) > n) break;
                    const auto& theirs = found_[static_cast<std::size_t>(other)];
                    const auto self = static_cast<std::int32_t>(n);
                    if (!std::binary_search(theirs.begin(), theirs.end(), self)) others_.local().push_back({other, self});
                }
        });
        NeighbourGraph graph;
        for (std::size_t n = 0; n < found_.size(); ++n)
            for (const std::int32_t other : found_[n])
                if (static_cast<std::size_t>(other) > n) graph.push_back({static_cast<std::int32_t>(n), other});
        const auto middle = std::ssize(graph);
        for (const NeighbourGraph& part : others_) graph.insert(graph.end(), part.begin(), part.end());
        std::sort(graph.begin() + middle, graph.end());
        std::inplace_merge(graph.begin(), graph.begin() + middle, graph.end());
        graph.erase(std::unique(graph.begin(), graph.end()), graph.end());
        return graph;
    }

    const std::vector<Site>& sites_;
    const Shape& shape_;
    double spacing_mm_;
    std::atomic<std::uint64_t>* cubes_looked_at_;
    double reach_mm_;
    Cube space_;
    SiteCulling<AdditiveMetric> culling_;
    std::vector<std::vector<std::int32_t>> found_;  ///< of each site, ascending
    std::vector<char> unbounded_;
    tbb::enumerable_thread_specific<NeighbourGraph> others_;
    tbb::enumerable_thread_specific<Workspace> workspaces_{[this] { return Workspace(1.0e-9 * spacing_mm_); }};
};

template <typename Metric>
NeighbourGraph search_all_of_space(const std::vector<Site>& sites, const std::vector<std::int32_t>& visible, const Shape& shape,
                                   double spacing_mm, std::atomic<std::uint64_t>* cubes_looked_at) {
    const Cube space = cube_around(shape.bounds_mm(), sites, {}, 0.0);
    const SiteCulling<Metric> culling(sites, box_of(space));
    tbb::enumerable_thread_specific<NeighbourGraph> found;
    FaceSearch(culling, shape, spacing_mm, AllPairs(), cubes_looked_at)
        .search_in_parallel(space.centre_mm, space.size_mm, false, visible,
                            [&](const PairSet& known) { known.append_to(found.local()); });
    throw_if_interrupted();
    NeighbourGraph graph;
    for (const NeighbourGraph& part : found) graph.insert(graph.end(), part.begin(), part.end());
    std::sort(graph.begin(), graph.end());
    graph.erase(std::unique(graph.begin(), graph.end()), graph.end());
    return graph;
}

}  // namespace

NeighbourGraph apollonius_graph(const std::vector<Site>& sites, const std::vector<char>& hidden, const Shape& shape,
                                double spacing_mm, TessellationKind kind, std::atomic<std::uint64_t>* cubes_looked_at) {
    Candidates visible;
    for (std::size_t n = 0; n < sites.size(); ++n)
        if (hidden[n] == 0) visible.push_back(static_cast<std::int32_t>(n));
    if (visible.size() < 2) return {};
    return with_metric(kind, [&](auto metric) {
        using Metric = decltype(metric);
        if constexpr (std::is_same_v<Metric, AdditiveMetric>)
            return CellByCell(sites, visible, shape, spacing_mm, cubes_looked_at).finish(visible);
        else
            return search_all_of_space<Metric>(sites, visible, shape, spacing_mm, cubes_looked_at);
    });
}

}  // namespace opal
