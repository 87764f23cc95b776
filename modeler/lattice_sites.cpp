// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/lattice_sites.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "formats/command.h"
#include "formats/error.h"
#include "formats/random.h"

namespace opal {
namespace {

using openvdb::Coord;
using openvdb::Vec3d;

constexpr double max_cells_per_axis = 0x1p20;
constexpr std::uint32_t max_draws = 8;

/// Cubic cells about the middle of a box.
class CubicLattice {
  public:
    CubicLattice(const openvdb::BBoxd& bounds_mm, double cells_per_mm) : bounds_mm_(bounds_mm) {
        const Vec3d extents = bounds_mm.extents();
        double fitted = 0.0, squares = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            const double cells = std::clamp(std::round(extents[axis] * cells_per_mm), 1.0, max_cells_per_axis);
            cells_[axis] = static_cast<std::int32_t>(cells);
            // A side that is thinner than its one cell has no say in the cell's edge.
            if (cells < 2.0 && extents[axis] * cells_per_mm < 0.5) continue;
            fitted += cells * extents[axis];
            squares += cells * cells;
        }
        cell_mm_ = squares > 0.0 ? fitted / squares : std::max({extents.x(), extents.y(), extents.z()});
        low_mm_ = bounds_mm.getCenter() - 0.5 * cell_mm_ * cells_.asVec3d();
    }

    const Coord& cells() const { return cells_; }
    double cell_mm() const { return cell_mm_; }
    double num_cells() const { return double(cells_.x()) * double(cells_.y()) * double(cells_.z()); }
    Vec3d centre_mm(const Coord& cell) const { return low_mm_ + cell_mm_ * (cell.asVec3d() + Vec3d(0.5)); }
    std::uint64_t number_of(const Coord& cell) const {
        return (std::uint64_t(cell.x()) * std::uint64_t(cells_.y()) + std::uint64_t(cell.y())) * std::uint64_t(cells_.z()) +
               std::uint64_t(cell.z());
    }

    /// A place for the cell's site, `unit` in [0, 1)^3 scaled into the middle part of the cell that lies within the bounds.
    Vec3d place_mm(const Coord& cell, double jitter, const Vec3d& unit) const {
        const Vec3d centre = centre_mm(cell), reach(0.5 * jitter * cell_mm_);
        const Vec3d low = openvdb::math::maxComponent(centre - reach, bounds_mm_.min());
        const Vec3d high = openvdb::math::minComponent(centre + reach, bounds_mm_.max());
        return low + unit * (high - low);
    }

  private:
    openvdb::BBoxd bounds_mm_;
    Coord cells_;
    double cell_mm_;
    Vec3d low_mm_;
};

/// The cells whose centres are inside the shape. Blocks of cells that the distance at their middle decides are not looked into.
class CellsInside {
  public:
    CellsInside(const Shape& shape, const CubicLattice& lattice) : shape_(shape), lattice_(lattice) {
        visit({Coord(0), lattice.cells().offsetBy(-1)});
        std::sort(cells_.begin(), cells_.end());
    }

    std::vector<Coord> take() { return std::move(cells_); }

  private:
    void visit(const openvdb::CoordBBox& block) {
        throw_if_interrupted();
        const Vec3d low = lattice_.centre_mm(block.min()), high = lattice_.centre_mm(block.max());
        const double distance_mm = shape_.signed_distance_mm(0.5 * (low + high));
        const double reach_mm = 0.5 * (high - low).length() * (1.0 + 1.0e-12);
        if (distance_mm > reach_mm) return;
        if (distance_mm < -reach_mm) {
            for (const Coord& cell : block) cells_.push_back(cell);
        } else if (block.min() == block.max()) {
            if (distance_mm < 0.0) cells_.push_back(block.min());
        } else {
            openvdb::CoordBBox lower = block, upper = block;
            const auto axis = static_cast<int>(block.maxExtent());
            lower.max()[axis] = (block.min()[axis] + block.max()[axis]) / 2;
            upper.min()[axis] = lower.max()[axis] + 1;
            visit(lower);
            visit(upper);
        }
    }

    const Shape& shape_;
    const CubicLattice& lattice_;
    std::vector<Coord> cells_;
};

/// The coarsest lattice with at least so many cells (for region shape: the coarsest that bisection finds).
class LatticeSearch {
  public:
    LatticeSearch(const Shape& shape, SiteRegion region, std::size_t wanted)
        : shape_(shape), region_(region), wanted_(wanted), bounds_mm_(shape.bounds_mm()) {}

    CubicLattice find() const {
        const openvdb::Vec3d extents = bounds_mm_.extents();
        double too_few = 0.25 / std::max({extents.x(), extents.y(), extents.z()});
        double enough = too_few;
        while (!has_enough(at(enough))) {
            too_few = enough;
            enough *= 1.25;
        }
        while (at(too_few).cells() != at(enough).cells()) {
            const double middle = 0.5 * (too_few + enough);
            if (!(middle > too_few && middle < enough)) break;
            (has_enough(at(middle)) ? enough : too_few) = middle;
        }
        return at(enough);
    }

  private:
    CubicLattice at(double cells_per_mm) const { return {bounds_mm_, cells_per_mm}; }

    bool has_enough(const CubicLattice& lattice) const {
        throw_if_interrupted();
        if (lattice.num_cells() >= static_cast<double>(wanted_) &&
            (region_ == SiteRegion::bounds || CellsInside(shape_, lattice).take().size() >= wanted_))
            return true;
        const Coord& n = lattice.cells();
        if (std::max({n.x(), n.y(), n.z()}) >= static_cast<std::int32_t>(max_cells_per_axis))
            throw InputError(
                fmt::format("grains.num_sites {}: no lattice of up to {:.0f} cells along a side has so many cells in this shape",
                            wanted_, max_cells_per_axis));
        return false;
    }

    const Shape& shape_;
    SiteRegion region_;
    std::size_t wanted_;
    openvdb::BBoxd bounds_mm_;
};

std::vector<Coord> all_cells(const CubicLattice& lattice) {
    std::vector<Coord> cells;
    cells.reserve(static_cast<std::size_t>(lattice.num_cells()));
    for (const Coord& cell : openvdb::CoordBBox(Coord(0), lattice.cells().offsetBy(-1))) cells.push_back(cell);
    return cells;
}

/// Keeps the cells whose centres lie deepest, in their order.
void keep_deepest(const Shape& shape, const CubicLattice& lattice, std::size_t count, std::vector<Coord>& cells) {
    if (cells.size() <= count) return;
    std::vector<std::pair<double, Coord>> by_depth(cells.size());
    tbb::parallel_for(std::size_t(0), cells.size(), [&](std::size_t n) {
        by_depth[n] = {shape.signed_distance_mm(lattice.centre_mm(cells[n])), cells[n]};
    });
    std::nth_element(by_depth.begin(), by_depth.begin() + static_cast<std::ptrdiff_t>(count), by_depth.end());
    cells.resize(count);
    for (std::size_t n = 0; n < count; ++n) cells[n] = by_depth[n].second;
    std::sort(cells.begin(), cells.end());
}

Vec3d jittered_place_mm(const Shape& shape, const GrainsRecipe& grains, const CubicLattice& lattice, const Coord& cell) {
    for (std::uint32_t draw = 0; draw < max_draws; ++draw) {
        const std::uint64_t number = lattice.number_of(cell);
        const RandomBlock low = random_block(grains.seed, RandomStream::lattice_jitter, number, 2 * draw);
        const RandomBlock high = random_block(grains.seed, RandomStream::lattice_jitter, number, 2 * draw + 1);
        const Vec3d unit(uniform_double(low.value[0], low.value[1]), uniform_double(low.value[2], low.value[3]),
                         uniform_double(high.value[0], high.value[1]));
        const Vec3d place_mm = lattice.place_mm(cell, grains.sites.jitter, unit);
        if (grains.sites.region == SiteRegion::bounds || shape.contains(place_mm)) return place_mm;
    }
    return lattice.centre_mm(cell);
}

}  // namespace

LatticeSites lattice_sites(const Shape& shape, const GrainsRecipe& grains) {
    const auto count = static_cast<std::size_t>(grains.num_sites);
    const bool whole_bounds = grains.sites.region == SiteRegion::bounds;
    const CubicLattice lattice = LatticeSearch(shape, grains.sites.region, count).find();

    LatticeSites sites;
    sites.cell_mm = lattice.cell_mm();
    sites.cells = whole_bounds ? all_cells(lattice) : CellsInside(shape, lattice).take();
    keep_deepest(shape, lattice, count, sites.cells);
    sites.positions_mm.resize(count);
    tbb::parallel_for(std::size_t(0), count,
                      [&](std::size_t n) { sites.positions_mm[n] = jittered_place_mm(shape, grains, lattice, sites.cells[n]); });
    return sites;
}

}  // namespace opal
