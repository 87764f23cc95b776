// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <vector>

#include "renderer/core/cell_field.h"

namespace opal {

/// Sites ordered along a Z curve, so that those near to one another in space are so in memory, and nested boxes around them, each
/// with the largest weight inside.
class SiteTree {
  public:
    /// Keeps `sites` by reference; they must be in the order of `z_order`.
    explicit SiteTree(const std::vector<CellSite>& sites);

    /// Calls visit(first, last) for ranges of at most `leaf_sites` sites, nearer boxes first, as long as `matters(gap_mm)` holds:
    /// no site in a box has |p_j - p| - (w_j - w) below its gap.
    template <class Matters, class Visit>
    void nearest_first(const openvdb::Vec3d& place_mm, double weight_mm, const Matters& matters, const Visit& visit) const {
        if (nodes_.empty()) return;
        struct Pending {
            std::uint32_t node;
            double gap_mm;
        };
        // Each level leaves one box behind; halving 2^32 sites takes 32 levels.
        Pending stack[2 * 32];
        int depth = 0;
        stack[depth++] = {0, gap_mm(nodes_[0], place_mm, weight_mm)};
        while (depth > 0) {
            const Pending next = stack[--depth];
            if (!matters(next.gap_mm)) continue;
            const Node& node = nodes_[next.node];
            if (node.child == 0) {
                if (!visit(node.first, node.last)) return;
                continue;
            }
            const Pending left{node.child, gap_mm(nodes_[node.child], place_mm, weight_mm)};
            const Pending right{node.child + 1, gap_mm(nodes_[node.child + 1], place_mm, weight_mm)};
            const bool left_first = left.gap_mm <= right.gap_mm;
            stack[depth++] = left_first ? right : left;
            stack[depth++] = left_first ? left : right;
        }
    }

    static constexpr std::uint32_t leaf_sites = 8;

  private:
    struct Node {
        openvdb::BBoxd box_mm;
        double largest_weight_mm;
        std::uint32_t first, last;
        std::uint32_t child;  ///< the first of two; 0 for a leaf
    };

    void build(std::uint32_t index, std::uint32_t first, std::uint32_t last);
    static double gap_mm(const Node& node, const openvdb::Vec3d& place_mm, double weight_mm);

    const std::vector<CellSite>& sites_;
    std::vector<Node> nodes_;
};

/// The order of places along a Z curve through their bounds; equal places keep their order.
std::vector<std::uint32_t> z_order(const std::vector<openvdb::Vec3d>& places_mm);

}  // namespace opal
