// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/majorant_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/error.h"

namespace opal {
namespace {

constexpr int finest_longest_side = 64;
/// A tentative collision (logarithm, random numbers, interpolation in the fields) costs as much as crossing so many cells:
/// measured (opal-bench media).
constexpr double collision_cost = 5.0;
/// A line through a grid of cubes meets 3/2 faces per edge length, averaged over directions.
constexpr double crossings_per_edge = 1.5;
/// Positions are rounded before a field is read: a cell counts what lies this little beyond it, in voxels.
constexpr double rounding_voxels = 0.01;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr MajorantCell nothing{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};

/// The cells, on each axis from first to last, in which interpolation reads a box of voxels.
struct CellRange {
    int first[3], last[3];

    bool single() const { return first[0] == last[0] && first[1] == last[1] && first[2] == last[2]; }
};

CellRange cells_that_read(const MajorantView& grid, const openvdb::math::Transform& transform, const openvdb::CoordBBox& voxels) {
    const double reach = 1.0 + rounding_voxels;
    const openvdb::Vec3d low_mm(double(grid.low_mm.x), double(grid.low_mm.y), double(grid.low_mm.z));
    const openvdb::Vec3d low = transform.indexToWorld(voxels.min().asVec3d() - reach) - low_mm;
    const openvdb::Vec3d high = transform.indexToWorld(voxels.max().asVec3d() + reach) - low_mm;
    CellRange range;
    for (int axis = 0; axis < 3; ++axis) {
        const double last = grid.size[axis] - 1;
        range.first[axis] = int(std::clamp(std::floor(low[axis] * double(grid.cells_per_mm)), 0.0, last));
        range.last[axis] = int(std::clamp(std::floor(high[axis] * double(grid.cells_per_mm)), 0.0, last));
    }
    return range;
}

void widen(MajorantCell& cell, int field, float low, float high) {
    cell.min[field] = std::min(cell.min[field], low);
    cell.max[field] = std::max(cell.max[field], high);
}

std::size_t flat_index(const int* size, int x, int y, int z) {
    return (std::size_t(z) * std::size_t(size[1]) + std::size_t(y)) * std::size_t(size[0]) + std::size_t(x);
}

template <typename Visit>
void for_each_cell(const MajorantView& grid, const CellRange& range, const Visit& visit) {
    for (int z = range.first[2]; z <= range.last[2]; ++z)
        for (int y = range.first[1]; y <= range.last[1]; ++y)
            for (int x = range.first[0]; x <= range.last[0]; ++x) visit(flat_index(grid.size, x, y, z));
}

/// Iterates over the active values above the leaves.
openvdb::FloatGrid::ValueOnCIter active_tiles(const openvdb::FloatGrid& grid) {
    auto tile = grid.cbeginValueOn();
    tile.setMaxDepth(openvdb::FloatGrid::ValueOnCIter::LEAF_DEPTH - 1);
    return tile;
}

openvdb::CoordBBox voxel_box(const openvdb::Coord& voxel) {
    return {voxel, voxel};
}

}  // namespace

MajorantGrid::MajorantGrid(const MediumFieldGrids& fields, const openvdb::BBoxd& bounds_mm, int longest_side) {
    const openvdb::Vec3d extents_mm = bounds_mm.extents();
    const double cell_mm = std::max({extents_mm.x(), extents_mm.y(), extents_mm.z()}) / longest_side;
    for (int axis = 0; axis < 3; ++axis)
        geometry_.size[axis] = std::clamp(int(std::ceil(extents_mm[axis] / cell_mm - 1.0e-6)), 1, longest_side);
    geometry_.low_mm = {float(bounds_mm.min().x()), float(bounds_mm.min().y()), float(bounds_mm.min().z())};
    geometry_.cells_per_mm = float(1.0 / cell_mm);
    cells_.assign(flat_index(geometry_.size, 0, 0, geometry_.size[2]), nothing);
    for (int field = 0; field < num_medium_fields; ++field)
        if (fields[std::size_t(field)]) add_field(field, *fields[std::size_t(field)]);
    for (MajorantCell& cell : cells_) {
        bool occupied = true;
        for (int field = 0; field < num_medium_fields; ++field) {
            const auto& grid = fields[std::size_t(field)];
            if (!grid) cell.min[field] = cell.max[field] = 1.0f;
            if (cell.min[field] <= cell.max[field]) continue;
            occupied = false;
            cell.min[field] = cell.max[field] = grid->background();
        }
        occupied_.push_back(occupied);
    }
}

MajorantGrid::MajorantGrid(std::vector<MajorantCell> cells, const MajorantView& geometry)
    : cells_(std::move(cells)), occupied_(cells_.size(), true), geometry_(geometry) {}

MajorantGrid MajorantGrid::fitted(const MediumFieldGrids& fields, const openvdb::BBoxd& bounds_mm,
                                  const std::array<double, num_medium_fields>& per_mm) {
    MajorantGrid best(fields, bounds_mm, finest_longest_side);
    for (MajorantGrid next = best; next.geometry_.size[0] > 1 || next.geometry_.size[1] > 1 || next.geometry_.size[2] > 1;) {
        next = next.coarser();
        if (next.cost_per_mm(per_mm) <= best.cost_per_mm(per_mm)) best = next;
    }
    return best;
}

void MajorantGrid::add_field(int field, const openvdb::FloatGrid& grid) {
    const auto add = [&](const CellRange& range, float low, float high) {
        for_each_cell(geometry_, range, [&](std::size_t cell) { widen(cells_[cell], field, low, high); });
    };
    const openvdb::math::Transform& transform = grid.transform();
    openvdb::CoordBBox box;
    for (auto tile = active_tiles(grid); tile; ++tile) {
        tile.getBoundingBox(box);
        add(cells_that_read(geometry_, transform, box), *tile, *tile);
    }
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        const CellRange range = cells_that_read(geometry_, transform, leaf->getNodeBoundingBox());
        if (range.single()) {
            MajorantCell& cell = cells_[flat_index(geometry_.size, range.first[0], range.first[1], range.first[2])];
            for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) widen(cell, field, *voxel, *voxel);
        } else {
            for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel)
                add(cells_that_read(geometry_, transform, voxel_box(voxel.getCoord())), *voxel, *voxel);
        }
    }
}

MajorantGrid MajorantGrid::coarser() const {
    MajorantView geometry = geometry_;
    geometry.cells_per_mm *= 0.5f;
    for (int& size : geometry.size) size = (size + 1) / 2;
    MajorantGrid result(std::vector<MajorantCell>(flat_index(geometry.size, 0, 0, geometry.size[2]), nothing), geometry);
    std::fill(result.occupied_.begin(), result.occupied_.end(), false);
    // Empty cells widen nothing unless there are only such.
    for (const bool occupied : {true, false})
        for (int z = 0; z < geometry_.size[2]; ++z)
            for (int y = 0; y < geometry_.size[1]; ++y)
                for (int x = 0; x < geometry_.size[0]; ++x) {
                    const std::size_t from = flat_index(geometry_.size, x, y, z);
                    const std::size_t to = flat_index(geometry.size, x / 2, y / 2, z / 2);
                    if (occupied_[from] != occupied || (!occupied && result.occupied_[to])) continue;
                    for (int f = 0; f < num_medium_fields; ++f)
                        widen(result.cells_[to], f, cells_[from].min[f], cells_[from].max[f]);
                    if (occupied) result.occupied_[to] = true;
                }
    return result;
}

double MajorantGrid::cost_per_mm(const std::array<double, num_medium_fields>& per_mm) const {
    double collisions_per_mm = 0.0;
    std::size_t occupied = 0;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        if (!occupied_[i]) continue;
        ++occupied;
        for (int f = 0; f < num_medium_fields; ++f)
            collisions_per_mm += per_mm[std::size_t(f)] * (double(cells_[i].max[f]) - double(cells_[i].min[f]));
    }
    const bool single = cells_.size() == 1;
    return collision_cost * collisions_per_mm / double(std::max<std::size_t>(1, occupied)) +
           (single ? 0.0 : crossings_per_edge * double(geometry_.cells_per_mm));
}

MajorantCell MajorantGrid::total() const {
    MajorantCell result = nothing;
    for (std::size_t i = 0; i < cells_.size(); ++i)
        if (occupied_[i])
            for (int f = 0; f < num_medium_fields; ++f) widen(result, f, cells_[i].min[f], cells_[i].max[f]);
    return result;
}

void check_majorants(const MediumFieldGrids& fields, const MajorantView& majorants,
                     const std::array<const char*, num_medium_fields>& names, const std::string& file) {
    for (std::size_t field = 0; field < fields.size(); ++field) {
        if (!fields[field]) continue;
        const auto require = [&](const openvdb::Coord& voxel, float value, const MajorantCell& cell) {
            if (value >= std::max(0.0f, cell.min[field]) && value <= cell.max[field] && std::isfinite(value)) return;
            const std::string place = fmt::format("{}: grid {}: voxel [{}, {}, {}] holds {}", file, names[field], voxel.x(),
                                                  voxel.y(), voxel.z(), value);
            if (!(value >= 0.0f && std::isfinite(value))) throw InputError(place + "; allowed: numbers from 0");
            throw InputError(fmt::format("{}, outside the bounds of a majorant cell that reads it: {} to {}", place,
                                         cell.min[field], cell.max[field]));
        };
        const openvdb::FloatGrid& grid = *fields[field];
        const auto require_box = [&](const openvdb::CoordBBox& box, float value) {
            for_each_cell(majorants, cells_that_read(majorants, grid.transform(), box),
                          [&](std::size_t cell) { require(box.min(), value, majorants.cells[cell]); });
        };
        openvdb::CoordBBox box;
        for (auto tile = active_tiles(grid); tile; ++tile) {
            tile.getBoundingBox(box);
            require_box(box, *tile);
        }
        for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf)
            for (auto value = leaf->cbeginValueOn(); value; ++value) require_box(voxel_box(value.getCoord()), *value);
    }
}

MajorantView MajorantGrid::view() const {
    MajorantView view = geometry_;
    view.cells = cells_.data();
    return view;
}

}  // namespace opal
