// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/cell_neighbors.h"

#include <algorithm>
#include <cmath>

namespace opal {
namespace {

/// Part of kappa by which a site may miss being a neighbour and still count as one.
constexpr double near_miss = 1.0e-5;
/// Sites that nearly coincide differ hardly in any direction; where dividing on costs more than it can save, all that is left
/// counts as neighbours.
constexpr std::size_t max_patches = 4096;
/// Where as many have been looked at in vain, it is the body's surface that bounds a cell.
constexpr std::size_t many_rivals = 256;

openvdb::Vec3d direction_of(int face, double u, double v) {
    const double sign = face % 2 == 0 ? 1.0 : -1.0;
    openvdb::Vec3d direction;
    direction[face / 2] = sign;
    direction[(face / 2 + 1) % 3] = u;
    direction[(face / 2 + 2) % 3] = v;
    return direction;
}

/// A square of a cube's face, seen from the cube's middle.
struct PatchGeometry {
    double x, y, z;  ///< unit direction of its centre
    double reach;    ///< no direction of the patch is farther from it (chord): a cap that holds the corners holds all of it

    PatchGeometry(int face, int edge, int u, int v) {
        const double half = 1.0 / edge;
        const double u_mid = (2 * u + 1) * half - 1.0, v_mid = (2 * v + 1) * half - 1.0;
        const openvdb::Vec3d centre = direction_of(face, u_mid, v_mid).unit();
        double reach2 = 0.0;
        for (const double u_side : {u_mid - half, u_mid + half})
            for (const double v_side : {v_mid - half, v_mid + half})
                reach2 = std::max(reach2, (direction_of(face, u_side, v_side).unit() - centre).lengthSqr());
        x = centre.x();
        y = centre.y();
        z = centre.z();
        reach = std::sqrt(reach2);
    }
};

constexpr int tabulated_levels = 4;

/// The patches of the first levels, one level after another.
const std::vector<PatchGeometry>& patch_table() {
    static const std::vector<PatchGeometry> table = [] {
        std::vector<PatchGeometry> patches;
        for (int level = 0; level < tabulated_levels; ++level) {
            const int edge = CellNeighborSearch::coarse_edge << level;
            for (int square = 0; square < 6 * edge * edge; ++square)
                patches.emplace_back(square / (edge * edge), edge, square / edge % edge, square % edge);
        }
        return patches;
    }();
    return table;
}

PatchGeometry patch_geometry(int face, int level, int u, int v) {
    const int edge = CellNeighborSearch::coarse_edge << level;
    if (level >= tabulated_levels) return PatchGeometry(face, edge, u, v);
    const int before = CellNeighborSearch::coarse_patches * ((1 << 2 * level) - 1) / 3;
    return patch_table()[std::size_t(before + (face * edge + u) * edge + v)];
}

openvdb::Vec3d place_of(const CellSite& site) {
    return {double(site.x), double(site.y), double(site.z)};
}

}  // namespace

CellNeighborSearch::CellNeighborSearch(const std::vector<CellSite>& sites, const SiteTree& tree, const ConvexBounds& bounds)
    : sites_(sites), tree_(tree), bounds_(bounds) {
    const openvdb::Vec3d extents_mm = bounds.box_mm().extents();
    near_mm_ = 4.0 * std::cbrt(extents_mm.x() * extents_mm.y() * extents_mm.z() / double(sites.size()));
    for (int patch = 0; patch < coarse_patches; ++patch) {
        const PatchGeometry& geometry = patch_table()[std::size_t(patch)];
        centre_x_[patch] = float(geometry.x);
        centre_y_[patch] = float(geometry.y);
        centre_z_[patch] = float(geometry.z);
        reach_[patch] = float(geometry.reach);
    }
}

bool CellNeighborSearch::is_hidden(std::uint32_t site) {
    const openvdb::Vec3d place = place_of(sites_[site]);
    const double weight = sites_[site].weight_mm;
    bool hidden = false;
    // A little above 0 for the rounding of a box's gap; the test of each site is exact enough to be the same for all.
    const auto matters = [](double gap_mm) { return gap_mm <= 1.0e-9; };
    tree_.nearest_first(place, weight, pending_, matters, [&](std::uint32_t first, std::uint32_t last) {
        for (std::uint32_t other = first; other < last && !hidden; ++other) {
            if (other == site) continue;
            const double lead = double(sites_[other].weight_mm) - weight;
            const double distance = (place_of(sites_[other]) - place).length();
            hidden = lead > distance || (lead == distance && (distance > 0.0 || other < site));
        }
        return !hidden;
    });
    return hidden;
}

void CellNeighborSearch::offer(const Rival& rival) {
    const auto x = float(rival.slope.x()), y = float(rival.slope.y()), z = float(rival.slope.z());
    const auto constant = float(rival.constant), steepness = float(rival.steepness), number = float(rivals_.size());
    OPAL_SIMD
    for (int patch = 0; patch < coarse_patches; ++patch) {
        const float kappa = centre_x_[patch] * x + centre_y_[patch] * y + centre_z_[patch] * z + constant;
        const float lowest = kappa - reach_[patch] * steepness;
        lowest_[patch] = lowest > lowest_[patch] ? lowest : lowest_[patch];
        winner_[patch] = kappa > best_[patch] ? number : winner_[patch];
        best_[patch] = kappa > best_[patch] ? kappa : best_[patch];
    }
    rivals_.push_back(rival);
}

void CellNeighborSearch::gather(std::uint32_t site) {
    const openvdb::Vec3d place = place_of(sites_[site]);
    const double weight = sites_[site].weight_mm;
    rivals_.clear();
    std::fill(std::begin(lowest_), std::end(lowest_), 0.0f);
    std::fill(std::begin(best_), std::end(best_), 0.0f);
    std::fill(std::begin(winner_), std::end(winner_), 0.0f);
    // The first six bound every cell; others only shorten the search: at once where they are near, else where it gets long.
    const auto offer_planes = [&](bool far) {
        for (std::size_t n = 0; n < bounds_.planes().size(); ++n) {
            const BoundingPlane& plane = bounds_.planes()[n];
            const double distance_mm = plane.offset_mm - plane.normal.dot(place);
            if (far == (n >= 6 && distance_mm > near_mm_)) offer({plane.normal / distance_mm, 0.0, 1.0 / distance_mm, -1});
        }
    };
    offer_planes(false);
    bool all_planes = false;
    double lowest = 0.0;
    // kappa_j <= 2 / (|g| - D), and |g| - D is at least the gap.
    const auto matters = [&](double gap_mm) { return gap_mm * lowest * (1.0 - near_miss) <= 2.0; };
    tree_.nearest_first(place, weight, pending_, matters, [&](std::uint32_t first, std::uint32_t last) {
        if (!all_planes && rivals_.size() > many_rivals) {
            offer_planes(true);
            all_planes = true;
        }
        for (std::uint32_t other = first; other < last; ++other) {
            if (other == site) continue;
            const openvdb::Vec3d offset = place_of(sites_[other]) - place;
            const double lead = double(sites_[other].weight_mm) - weight, distance = offset.length();
            if (!matters(distance - lead)) continue;
            const double scale = 2.0 / ((distance - lead) * (distance + lead));
            offer({scale * offset, scale * lead, scale * distance, std::int32_t(other)});
        }
        float least = lowest_[0];
#pragma omp simd reduction(min : least)
        for (int patch = 0; patch < coarse_patches; ++patch) least = lowest_[patch] < least ? lowest_[patch] : least;
        lowest = least;
        return true;
    });
    std::uint32_t kept = 0;
    std::vector<std::uint32_t> moved(rivals_.size(), 0);
    for (std::uint32_t n = 0; n < rivals_.size(); ++n)
        if (rivals_[n].steepness + rivals_[n].constant >= lowest * (1.0 - near_miss)) {
            moved[n] = kept;
            rivals_[kept++] = rivals_[n];
        }
    rivals_.resize(kept);
    for (float& winner : winner_) winner = float(moved[std::size_t(winner)]);
}

void CellNeighborSearch::mark_winners() {
    is_neighbor_.assign(rivals_.size(), 0);
    for (std::size_t n = 0; n < rivals_.size(); ++n) is_neighbor_[n] = rivals_[n].site < 0 ? 1 : 0;
    for (const float winner : winner_) is_neighbor_[std::size_t(winner)] = 1;
}

/// Drops the rivals that cannot win in a patch; divides it where others than known neighbours are left.
void CellNeighborSearch::settle(const Patch& patch, bool finest) {
    const PatchGeometry geometry = patch_geometry(patch.face, patch.level, patch.u, patch.v);
    kappa_.clear();
    std::size_t winner_at = 0;
    for (std::uint32_t k = patch.first; k < patch.last; ++k) {
        const Rival& rival = rivals_[in_patch_[k]];
        kappa_.push_back(geometry.x * rival.slope.x() + geometry.y * rival.slope.y() + geometry.z * rival.slope.z() +
                         rival.constant);
        if (kappa_.back() > kappa_[winner_at]) winner_at = kappa_.size() - 1;
    }
    const std::uint32_t winner = in_patch_[patch.first + winner_at];
    const double best = kappa_[winner_at] * (1.0 - near_miss), reach2 = geometry.reach * geometry.reach;
    is_neighbor_[winner] = 1;
    const auto kept = std::uint32_t(in_finer_patch_.size());
    bool settled = true;
    for (std::uint32_t k = patch.first; k < patch.last; ++k) {
        const double behind = best - kappa_[k - patch.first];
        const double catches_up2 = reach2 * (rivals_[in_patch_[k]].slope - rivals_[winner].slope).lengthSqr();
        if (behind > 0.0 && behind * behind > catches_up2) continue;
        in_finer_patch_.push_back(in_patch_[k]);
        if (finest) is_neighbor_[in_patch_[k]] = 1;
        settled = settled && is_neighbor_[in_patch_[k]] != 0;
    }
    if (settled) {
        in_finer_patch_.resize(kept);
        return;
    }
    for (int quarter = 0; quarter < 4; ++quarter)
        finer_patches_.push_back({patch.face, patch.level + 1, 2 * patch.u + quarter / 2, 2 * patch.v + quarter % 2, kept,
                                  std::uint32_t(in_finer_patch_.size())});
}

void CellNeighborSearch::list_coarse_patches() {
    for (std::vector<std::uint32_t>& rivals : may_win_) rivals.clear();
    for (std::uint32_t n = 0; n < rivals_.size(); ++n) {
        const auto x = float(rivals_[n].slope.x()), y = float(rivals_[n].slope.y()), z = float(rivals_[n].slope.z());
        const auto constant = float(rivals_[n].constant), steepness = float(rivals_[n].steepness);
        float margin[coarse_patches];
        OPAL_SIMD
        for (int patch = 0; patch < coarse_patches; ++patch)
            margin[patch] = centre_x_[patch] * x + centre_y_[patch] * y + centre_z_[patch] * z + constant +
                            reach_[patch] * steepness - (1.0f - float(near_miss)) * lowest_[patch];
        for (int patch = 0; patch < coarse_patches; ++patch)
            if (margin[patch] >= 0.0f) may_win_[patch].push_back(n);
    }
    in_patch_.clear();
    patches_.clear();
    for (int patch = 0; patch < coarse_patches; ++patch) {
        const auto first = std::uint32_t(in_patch_.size());
        in_patch_.insert(in_patch_.end(), may_win_[patch].begin(), may_win_[patch].end());
        patches_.push_back({patch / (coarse_edge * coarse_edge), 0, patch / coarse_edge % coarse_edge, patch % coarse_edge, first,
                            std::uint32_t(in_patch_.size())});
    }
}

void CellNeighborSearch::refine() {
    list_coarse_patches();
    while (!patches_.empty()) {
        in_finer_patch_.clear();
        finer_patches_.clear();
        const bool finest = patches_.front().level == finest_level || patches_.size() > max_patches;
        for (const Patch& patch : patches_) settle(patch, finest);
        std::swap(in_patch_, in_finer_patch_);
        std::swap(patches_, finer_patches_);
    }
}

void CellNeighborSearch::find(std::uint32_t site, std::vector<std::int32_t>& neighbors) {
    gather(site);
    mark_winners();
    refine();
    neighbors.clear();
    for (std::size_t n = 0; n < rivals_.size(); ++n)
        if (is_neighbor_[n] != 0 && rivals_[n].site >= 0) neighbors.push_back(rivals_[n].site);
    std::sort(neighbors.begin(), neighbors.end());
}

}  // namespace opal
