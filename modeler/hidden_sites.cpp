// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/hidden_sites.h"

#include <openvdb/openvdb.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>

#include "modeler/tessellation_metric.h"

namespace opal {
namespace {

/// Boxes of sites, halved along their longest side, each with its largest weight: where even that weight, at the box's nearest
/// place, would not hide a site, nothing in the box does.
class WeightTree {
  public:
    explicit WeightTree(const std::vector<Site>& sites) : sites_(sites), order_(sites.size()) {
        std::iota(order_.begin(), order_.end(), std::size_t(0));
        if (sites.empty()) return;
        nodes_.emplace_back();
        build(0, 0, sites.size());
    }

    template <typename Metric>
    bool hides(std::size_t site) const {
        std::size_t stack[max_stack];
        std::size_t depth = 0;
        stack[depth++] = 0;
        while (depth > 0) {
            const Node& node = nodes_[stack[--depth]];
            if (!can_hide<Metric>(node, sites_[site])) continue;
            if (node.child == 0) {
                for (std::size_t n = node.first; n < node.last; ++n)
                    if (order_[n] != site && hides<Metric>(order_[n], site)) return true;
                continue;
            }
            // The box with more to give is searched first.
            const bool left_first = promise(nodes_[node.child], sites_[site]) > promise(nodes_[node.child + 1], sites_[site]);
            stack[depth++] = node.child + (left_first ? 1 : 0);
            stack[depth++] = node.child + (left_first ? 0 : 1);
        }
        return false;
    }

  private:
    static constexpr std::size_t leaf_sites = 8;
    /// Each level leaves one box behind; halving 2^64 sites takes 64 levels.
    static constexpr std::size_t max_stack = 2 * 64;

    struct Node {
        openvdb::BBoxd box_mm;
        double largest_weight = -std::numeric_limits<double>::infinity();
        std::size_t first = 0, last = 0;
        std::size_t child = 0;  ///< the first of two; 0 for a leaf
    };

    void build(std::size_t index, std::size_t first, std::size_t last) {
        Node node;
        node.first = first;
        node.last = last;
        for (std::size_t n = first; n < last; ++n) {
            node.box_mm.expand(sites_[order_[n]].position_mm);
            node.largest_weight = std::max(node.largest_weight, static_cast<double>(sites_[order_[n]].weight_mm));
        }
        if (last - first > leaf_sites) {
            node.child = nodes_.size();
            nodes_.resize(nodes_.size() + 2);
            const auto axis = static_cast<int>(node.box_mm.maxExtent());
            const std::size_t middle = first + (last - first) / 2;
            const auto at = [&](std::size_t n) { return order_.begin() + static_cast<std::ptrdiff_t>(n); };
            std::nth_element(at(first), at(middle), at(last), [&](std::size_t a, std::size_t b) {
                return sites_[a].position_mm[axis] < sites_[b].position_mm[axis];
            });
            build(node.child, first, middle);
            build(node.child + 1, middle, last);
        }
        nodes_[index] = node;
    }

    static double distance_mm(const Node& node, const openvdb::Vec3d& place_mm) {
        openvdb::Vec3d outside_mm;
        for (int axis = 0; axis < 3; ++axis)
            outside_mm[axis] =
                std::max({0.0, node.box_mm.min()[axis] - place_mm[axis], place_mm[axis] - node.box_mm.max()[axis]});
        return outside_mm.length();
    }

    static double promise(const Node& node, const Site& site) {
        return node.largest_weight - distance_mm(node, site.position_mm);
    }

    template <typename Metric>
    static bool can_hide(const Node& node, const Site& site) {
        const double lead = node.largest_weight - static_cast<double>(site.weight_mm);
        // The factor covers rounding. A factor for a weight hides only in its own place.
        if constexpr (Metric::uniform_slope) return lead * (1.0 + 1.0e-12) >= distance_mm(node, site.position_mm);
        return distance_mm(node, site.position_mm) == 0.0;
    }

    template <typename Metric>
    bool hides(std::size_t other, std::size_t site) const {
        return Metric::hides(sites_[other], sites_[site], sites_[other].position_mm - sites_[site].position_mm, other < site);
    }

    const std::vector<Site>& sites_;
    std::vector<std::size_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace

std::vector<char> find_hidden_sites(const std::vector<Site>& sites, TessellationKind tessellation) {
    const WeightTree tree(sites);
    std::vector<char> hidden(sites.size(), 0);
    with_metric(tessellation, [&](auto metric) {
        tbb::parallel_for(std::size_t(0), sites.size(),
                          [&](std::size_t n) { hidden[n] = tree.hides<decltype(metric)>(n) ? 1 : 0; });
    });
    return hidden;
}

}  // namespace opal
