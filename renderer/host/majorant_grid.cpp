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
constexpr double collision_cost = 10.0;
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
void for_each_cell(const CellRange& range, const Visit& visit) {
    for (int z = range.first[2]; z <= range.last[2]; ++z)
        for (int y = range.first[1]; y <= range.last[1]; ++y)
            for (int x = range.first[0]; x <= range.last[0]; ++x) visit(x, y, z);
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

MajorantGrid::MajorantGrid(const MediumFieldGrids& fields, const openvdb::BBoxd& bounds_mm, int longest_side)
    : MajorantGrid(reached(fields, bounds_mm, longest_side)) {
    fill_unreached(fields);
}

MajorantGrid MajorantGrid::reached(const MediumFieldGrids& fields, const openvdb::BBoxd& bounds_mm, int longest_side) {
    const openvdb::Vec3d extents_mm = bounds_mm.extents();
    const double cell_mm = std::max({extents_mm.x(), extents_mm.y(), extents_mm.z()}) / longest_side;
    MajorantView geometry;
    for (int axis = 0; axis < 3; ++axis)
        geometry.size[axis] = std::clamp(int(std::ceil(extents_mm[axis] / cell_mm - 1.0e-6)), 1, longest_side);
    geometry.low_mm = {float(bounds_mm.min().x()), float(bounds_mm.min().y()), float(bounds_mm.min().z())};
    geometry.cells_per_mm = float(1.0 / cell_mm);
    MajorantGrid grid(std::vector<MajorantCell>(flat_index(geometry.size, 0, 0, geometry.size[2]), nothing), geometry);
    for (int field = 0; field < num_medium_fields; ++field) {
        if (fields[std::size_t(field)])
            grid.add_field(field, *fields[std::size_t(field)]);
        else
            for (MajorantCell& cell : grid.cells_) widen(cell, field, 1.0f, 1.0f);
    }
    return grid;
}

void MajorantGrid::fill_unreached(const MediumFieldGrids& fields) {
    for (MajorantCell& cell : cells_)
        for (int field = 0; field < num_medium_fields; ++field)
            if (cell.min[field] > cell.max[field]) cell.min[field] = cell.max[field] = fields[std::size_t(field)]->background();
}

MajorantGrid::MajorantGrid(std::vector<MajorantCell> cells, const MajorantView& geometry)
    : cells_(std::move(cells)), geometry_(geometry) {}

MajorantGrid MajorantGrid::fitted(const MediumFieldGrids& fields, const openvdb::BBoxd& bounds_mm,
                                  const std::array<double, num_medium_fields>& per_mm) {
    MajorantGrid best = reached(fields, bounds_mm, finest_longest_side);
    double least = best.cost_per_mm(per_mm);
    for (MajorantGrid next = best; next.cells_.size() > 1;) {
        next = next.coarser();
        const double cost = next.cost_per_mm(per_mm);
        if (cost > least) continue;
        least = cost;
        best = next;
    }
    best.fill_unreached(fields);
    return best;
}

MajorantGrid MajorantGrid::chosen(const MediumFieldGrids& fields, const openvdb::BBoxd& bounds_mm, MajorantKind majorants,
                                  TrackingKind tracking, const std::array<double, num_medium_fields>& per_mm) {
    const MajorantGrid grid =
        majorants == MajorantKind::global ? MajorantGrid(fields, bounds_mm, 1) : fitted(fields, bounds_mm, per_mm);
    return tracking == TrackingKind::ratio ? grid.without_least(fields) : grid;
}

MajorantGrid MajorantGrid::without_least(const MediumFieldGrids& fields) const {
    MajorantGrid result = *this;
    for (MajorantCell& cell : result.cells_)
        for (int field = 0; field < num_medium_fields; ++field)
            if (fields[std::size_t(field)]) cell.min[field] = 0.0f;
    return result;
}

void MajorantGrid::add_field(int field, const openvdb::FloatGrid& grid) {
    const auto add = [&](const CellRange& range, float low, float high) {
        for_each_cell(range, [&](int x, int y, int z) { widen(cells_[flat_index(geometry_.size, x, y, z)], field, low, high); });
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
    std::vector<MajorantCell> merged(flat_index(geometry.size, 0, 0, geometry.size[2]), nothing);
    const CellRange all{{0, 0, 0}, {geometry_.size[0] - 1, geometry_.size[1] - 1, geometry_.size[2] - 1}};
    std::size_t from = 0;
    for_each_cell(all, [&](int x, int y, int z) {
        const MajorantCell& cell = cells_[from++];
        for (int f = 0; f < num_medium_fields; ++f)
            widen(merged[flat_index(geometry.size, x / 2, y / 2, z / 2)], f, cell.min[f], cell.max[f]);
    });
    return MajorantGrid(std::move(merged), geometry);
}

double MajorantGrid::cost_per_mm(const std::array<double, num_medium_fields>& per_mm) const {
    double collisions_per_mm = 0.0;
    std::size_t reached = 0;
    for (const MajorantCell& cell : cells_) {
        double rest_per_mm = 0.0;
        for (int f = 0; f < num_medium_fields; ++f)
            rest_per_mm += per_mm[std::size_t(f)] * (double(cell.max[f]) - double(cell.min[f]));
        if (!(rest_per_mm >= 0.0)) continue;  // a cell outside, which some field does not reach
        collisions_per_mm += rest_per_mm;
        ++reached;
    }
    const double crossings_per_mm = cells_.size() == 1 ? 0.0 : crossings_per_edge * double(geometry_.cells_per_mm);
    return collision_cost * collisions_per_mm / double(std::max<std::size_t>(1, reached)) + crossings_per_mm;
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
            for_each_cell(cells_that_read(majorants, grid.transform(), box), [&](int x, int y, int z) {
                require(box.min(), value, majorants.cells[flat_index(majorants.size, x, y, z)]);
            });
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
