// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <vector>

#include "renderer/host/convex_bounds.h"
#include "renderer/host/site_tree.h"

namespace opal {

/// Finds the neighbours of one cell after another of an additively weighted Voronoi diagram within bounds.
///
/// Seen from its site, a cell is star-shaped, and one over its radius in direction v is the largest of
///   kappa_j(v) = v.G_j + C_j,  G_j = 2 g / (|g|^2 - D^2),  C_j = 2 D / (|g|^2 - D^2),  g = p_j - p_i,  D = w_j - w_i
/// over all other sites j (and over the faces of the bounds, which are planes: C = 0). j is a neighbour where its kappa is the
/// largest in some direction. kappa is linear in v, hence |G_j|-Lipschitz on the sphere of directions, which is divided into
/// patches until each patch is left with sites that are known to be neighbours: those that win at the centre of some patch. Sites
/// beyond twice the largest radius found so far need no look: kappa_j <= 2 / (|g| - D).
///
/// The result holds every neighbour. Beside them it holds only sites that come within a part in 10^5 of kappa of being one, or
/// within what the smallest patches (about 0.01 rad) resolve: what a walk in single precision could mistake for neighbours is
/// not missing either.
class CellNeighborSearch {
  public:
    /// The coarsest patches are squares of a cube's faces, so many along an edge.
    static constexpr int coarse_edge = 4;
    static constexpr int coarse_patches = 6 * coarse_edge * coarse_edge;

    /// Keeps all by reference. All sites lie inside the bounds.
    CellNeighborSearch(const std::vector<CellSite>& sites, const SiteTree& tree, const ConvexBounds& bounds);

    /// Whether another site is at least as near as `site` everywhere; of equal sites in one place the first is not hidden.
    bool is_hidden(std::uint32_t site);

    /// The candidates for neighbours of `site`, ascending. No site may be hidden.
    void find(std::uint32_t site, std::vector<std::int32_t>& neighbors);

  private:
    /// Of another site, or (site < 0) of a face of the bounds.
    struct Rival {
        openvdb::Vec3d slope;  ///< G
        double constant;       ///< C
        double steepness;      ///< |G|
        std::int32_t site;
    };
    /// A square of a cube's face, seen from the cube's middle.
    struct Patch {
        int face, level;
        int u, v;                   ///< of 4 * 2^level squares along an edge
        std::uint32_t first, last;  ///< rivals that may win in it
    };
    static constexpr int finest_level = 5;

    void offer(const Rival& rival);
    void gather(std::uint32_t site);
    void mark_winners();
    void list_coarse_patches();
    void refine();
    void settle(const Patch& patch, bool finest);

    const std::vector<CellSite>& sites_;
    const SiteTree& tree_;
    const ConvexBounds& bounds_;
    double near_mm_;  ///< a few times the distance between sites

    // The coarse patches' centres and how far their corners are from them. Single precision is far below near misses.
    float centre_x_[coarse_patches], centre_y_[coarse_patches], centre_z_[coarse_patches], reach_[coarse_patches];
    // For the present cell, in each coarse patch: a lower bound of the largest kappa; the largest at the centre and whose it is.
    float lowest_[coarse_patches], best_[coarse_patches], winner_[coarse_patches];
    std::vector<SiteTree::Pending> pending_;
    std::vector<Rival> rivals_;
    std::vector<std::uint32_t> may_win_[coarse_patches];  ///< rivals, in each coarse patch
    std::vector<char> is_neighbor_;
    std::vector<double> kappa_;
    std::vector<std::uint32_t> in_patch_, in_finer_patch_;
    std::vector<Patch> patches_, finer_patches_;
};

}  // namespace opal
