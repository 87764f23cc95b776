// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace opal {

/// Points in the order of the cells of a uniform grid, for loops over everybody's neighbours within one fixed reach. From here on
/// a point goes by its place in that order, which keeps neighbours close in memory; a row of three cells is one range of it.
class SampleCells {
  public:
    SampleCells(const std::vector<openvdb::Vec3d>& points, double reach);

    std::size_t size() const { return index_.size(); }
    double reach() const { return reach_; }
    /// Index of the point at a place, in the list that the cells were made from.
    std::size_t index(std::size_t place) const { return index_[place]; }

    /// Calls `visit(place, squared_distance)` for every other point nearer than the reach.
    template <typename Visitor>
    void for_each_neighbour(std::size_t place, const Visitor& visit) const {
        // Distances first, without a branch in the loop: most points of the row are out of reach, at random.
        double squared[chunk_size];
        std::uint32_t within[chunk_size];
        for_each_row(place, [&](std::size_t begin, std::size_t end) {
            for (; begin < end; begin += chunk_size) {
                const std::size_t count = std::min(chunk_size, end - begin);
                for (std::size_t n = 0; n < count; ++n) squared[n] = squared_distance(place, begin + n);
                std::size_t num_within = 0;
                for (std::size_t n = 0; n < count; ++n) {
                    within[num_within] = static_cast<std::uint32_t>(n);
                    num_within += squared[n] < squared_reach_ ? 1 : 0;
                }
                for (std::size_t n = 0; n < num_within; ++n)
                    if (begin + within[n] != place) visit(begin + within[n], squared[within[n]]);
            }
        });
    }

    /// The cells stand in planes, neighbours at most one plane apart.
    std::size_t num_planes() const { return num_cells_[0]; }
    std::size_t plane_begin(std::size_t plane) const { return cell_begin_[plane * num_cells_[1] * num_cells_[2]]; }

    double squared_distance(std::size_t a, std::size_t b) const {
        const double dx = axis_[0][a] - axis_[0][b];
        const double dy = axis_[1][a] - axis_[1][b];
        const double dz = axis_[2][a] - axis_[2][b];
        return dx * dx + dy * dy + dz * dz;
    }

  private:
    using Cell = std::array<std::size_t, 3>;
    static constexpr std::size_t chunk_size = 64;

    std::size_t cell_along(int axis, double coordinate) const {
        return static_cast<std::size_t>((coordinate - origin_[axis]) / cell_size_);
    }

    /// Calls `work(begin, end)` for ranges of places that hold all neighbours.
    template <typename Work>
    void for_each_row(std::size_t place, const Work& work) const {
        Cell low, high;
        for (int axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<std::size_t>(axis);
            const std::size_t middle = cell_along(axis, axis_[a][place]);
            low[a] = middle > 0 ? middle - 1 : 0;
            high[a] = std::min(middle + 1, num_cells_[a] - 1);
        }
        for (std::size_t i = low[0]; i <= high[0]; ++i)
            for (std::size_t j = low[1]; j <= high[1]; ++j) {
                const std::size_t row = (i * num_cells_[1] + j) * num_cells_[2];
                work(cell_begin_[row + low[2]], cell_begin_[row + high[2] + 1]);
            }
    }

    double reach_;
    double squared_reach_;
    double cell_size_;
    openvdb::Vec3d origin_;
    Cell num_cells_;
    std::array<std::vector<double>, 3> axis_;  ///< coordinates
    std::vector<std::uint32_t> index_;
    std::vector<std::uint32_t> cell_begin_;
};

/// The shortest distance between any two of the points; 0 for fewer than two. `typical` is a first guess at it.
double shortest_distance(const std::vector<openvdb::Vec3d>& points, double typical);

}  // namespace opal
