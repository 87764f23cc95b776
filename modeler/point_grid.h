// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace opal {

/// Points sorted into the cells of a uniform grid, cells into hash buckets: finds the points near a place in constant time,
/// however large and empty the space. Queries are safe from several threads.
class PointGrid {
  public:
    /// Best cell size: about the radius that will be asked for.
    PointGrid(const std::vector<openvdb::Vec3d>& points, double cell_size);

    /// Whether `predicate(index, squared_distance)` holds for a point within `radius`; stops at the first one.
    template <typename Predicate>
    bool any_within(const openvdb::Vec3d& centre, double radius, const Predicate& predicate) const {
        const double squared_radius = radius * radius;
        const auto test = [&](const Entry& entry) {
            const double squared_distance = (entry.position - centre).lengthSqr();
            return squared_distance <= squared_radius && predicate(entry.index, squared_distance);
        };
        const Cell low = cell_of(centre - openvdb::Vec3d(radius));
        const Cell high = cell_of(centre + openvdb::Vec3d(radius));
        double cells = 1.0;
        for (int axis = 0; axis < 3; ++axis) cells *= static_cast<double>(high.index[axis] - low.index[axis] + 1);
        if (cells > static_cast<double>(entries_.size())) {
            for (const Entry& entry : entries_)
                if (test(entry)) return true;
            return false;
        }
        for (std::int64_t i = low.index[0]; i <= high.index[0]; ++i)
            for (std::int64_t j = low.index[1]; j <= high.index[1]; ++j)
                for (std::int64_t k = low.index[2]; k <= high.index[2]; ++k) {
                    const std::uint64_t key = key_of({{i, j, k}});
                    const std::size_t bucket = bucket_of(key);
                    for (std::size_t n = bucket_begin_[bucket]; n < bucket_begin_[bucket + 1]; ++n)
                        if (entries_[n].key == key && test(entries_[n])) return true;
                }
        return false;
    }

    /// Calls `visit(index, squared_distance)` for every point within `radius`.
    template <typename Visitor>
    void for_each_within(const openvdb::Vec3d& centre, double radius, const Visitor& visit) const {
        any_within(centre, radius, [&](std::size_t index, double squared_distance) {
            visit(index, squared_distance);
            return false;
        });
    }

  private:
    struct Cell {
        std::int64_t index[3];
    };
    struct Entry {
        openvdb::Vec3d position;
        std::uint64_t key;
        std::size_t index;
    };

    Cell cell_of(const openvdb::Vec3d& point) const;
    static std::uint64_t key_of(const Cell& cell);
    std::size_t bucket_of(std::uint64_t key) const {
        return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15u) >> bucket_shift_);
    }

    openvdb::Vec3d origin_;
    double cell_size_;
    int bucket_shift_;
    std::vector<std::size_t> bucket_begin_;
    std::vector<Entry> entries_;
};

}  // namespace opal
