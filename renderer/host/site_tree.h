// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <algorithm>
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

    /// A box yet to be looked into. No site in it has |p_j - p| - (w_j - w) below its gap.
    struct Pending {
        double gap_mm;
        std::uint32_t node;
        bool operator<(const Pending& other) const { return gap_mm > other.gap_mm; }  ///< the smallest gap on top of a heap
    };

    /// Calls visit(first, last) for ranges of at most `leaf_sites` sites, those of the smallest gap first, as long as
    /// `matters(gap_mm)` holds and visit returns true. `pending` is working space.
    template <class Matters, class Visit>
    void nearest_first(const openvdb::Vec3d& place_mm, double weight_mm, std::vector<Pending>& pending, const Matters& matters,
                       const Visit& visit) const {
        pending.clear();
        if (!nodes_.empty()) pending.push_back({gap_mm(nodes_[0], place_mm, weight_mm), 0});
        while (!pending.empty() && matters(pending.front().gap_mm)) {
            const Node& node = nodes_[pending.front().node];
            std::pop_heap(pending.begin(), pending.end());
            pending.pop_back();
            if (node.child == 0) {
                if (!visit(node.first, node.last)) return;
                continue;
            }
            for (std::uint32_t child = node.child; child < node.child + 2; ++child) {
                pending.push_back({gap_mm(nodes_[child], place_mm, weight_mm), child});
                std::push_heap(pending.begin(), pending.end());
            }
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
