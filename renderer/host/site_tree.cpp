// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/site_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace opal {
namespace {

/// The lowest 21 bits of a number, two zeros after each.
std::uint64_t spread_bits(std::uint64_t bits) {
    std::uint64_t spread = 0;
    for (int bit = 0; bit < 21; ++bit) spread |= ((bits >> bit) & 1u) << (3 * bit);
    return spread;
}

}  // namespace

SiteTree::SiteTree(const std::vector<CellSite>& sites) : sites_(sites) {
    if (sites.empty()) return;
    nodes_.emplace_back();
    build(0, 0, std::uint32_t(sites.size()));
}

void SiteTree::build(std::uint32_t index, std::uint32_t first, std::uint32_t last) {
    Node node{openvdb::BBoxd(), -std::numeric_limits<double>::infinity(), first, last, 0};
    if (last - first > leaf_sites) {
        node.child = std::uint32_t(nodes_.size());
        nodes_.resize(nodes_.size() + 2);
        const std::uint32_t middle = first + (last - first) / 2;
        build(node.child, first, middle);
        build(node.child + 1, middle, last);
        for (std::uint32_t child = node.child; child < node.child + 2; ++child) {
            node.box_mm.expand(nodes_[child].box_mm);
            node.largest_weight_mm = std::max(node.largest_weight_mm, nodes_[child].largest_weight_mm);
        }
    } else {
        for (std::uint32_t n = first; n < last; ++n) {
            node.box_mm.expand(openvdb::Vec3d(sites_[n].x, sites_[n].y, sites_[n].z));
            node.largest_weight_mm = std::max(node.largest_weight_mm, double(sites_[n].weight_mm));
        }
    }
    nodes_[index] = node;
}

double SiteTree::gap_mm(const Node& node, const openvdb::Vec3d& place_mm, double weight_mm) {
    double distance2 = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double outside_mm =
            std::max({0.0, node.box_mm.min()[axis] - place_mm[axis], place_mm[axis] - node.box_mm.max()[axis]});
        distance2 += outside_mm * outside_mm;
    }
    return std::sqrt(distance2) - (node.largest_weight_mm - weight_mm);
}

std::vector<std::uint32_t> z_order(const std::vector<openvdb::Vec3d>& places_mm) {
    openvdb::BBoxd box;
    for (const openvdb::Vec3d& place : places_mm) box.expand(place);
    double longest_mm = std::numeric_limits<double>::min();
    for (int axis = 0; axis < 3 && !places_mm.empty(); ++axis) longest_mm = std::max(longest_mm, box.extents()[axis]);
    std::vector<std::uint64_t> codes;
    for (const openvdb::Vec3d& place : places_mm) {
        std::uint64_t code = 0;
        for (int axis = 0; axis < 3; ++axis)
            code |= spread_bits(std::uint64_t((place[axis] - box.min()[axis]) / longest_mm * double((1u << 21) - 1))) << axis;
        codes.push_back(code);
    }
    std::vector<std::uint32_t> order(places_mm.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
    return order;
}

}  // namespace opal
