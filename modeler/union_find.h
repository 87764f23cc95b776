// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace opal {

/// Disjoint sets of elements 0..n-1 with their sizes; union by size, paths halved.
class UnionFind {
  public:
    explicit UnionFind(std::size_t count) : parent_(count), size_(count, 1) {
        std::iota(parent_.begin(), parent_.end(), std::size_t(0));
    }

    std::size_t root(std::size_t element) {
        while (parent_[element] != element) element = parent_[element] = parent_[parent_[element]];
        return element;
    }
    std::size_t size_at(std::size_t root_element) const { return size_[root_element]; }

    /// Joins the sets of two different roots; returns the size of the union.
    std::size_t join(std::size_t root_a, std::size_t root_b) {
        if (size_[root_a] < size_[root_b]) std::swap(root_a, root_b);
        parent_[root_b] = root_a;
        return size_[root_a] += size_[root_b];
    }

  private:
    std::vector<std::size_t> parent_;
    std::vector<std::size_t> size_;
};

}  // namespace opal
