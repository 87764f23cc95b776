// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/cell_data.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "formats/units.h"
#include "renderer/host/cell_neighbors.h"

namespace opal {
namespace {

constexpr std::size_t sites_per_task = 64;
constexpr double sites_per_start_box = 2.0;
constexpr double fewest_places = 500'000.0, most_places = 4'000'000.0;
constexpr double places_per_site = 256.0;
/// The walk's distances and offsets add up to some ten roundings of the coordinates.
constexpr double roundings = 16.0;

}  // namespace

CellData::CellData(const std::vector<Site>& sites, ConvexBounds bounds) {
    std::vector<openvdb::Vec3d> places_mm;
    std::vector<const Site*> owners;
    for (const Site& site : sites) {
        if (site.grain == 0) continue;
        places_mm.push_back(site.position_mm);
        owners.push_back(&site);
        bounds.hold(site.position_mm);
    }
    // Room for the rounding of sites and rays; faces at a distance from every site.
    bounds.widen(1.0e-3 * bounds.box_mm().extents().length() + 1.0e-6);
    const openvdb::BBoxd box_mm = bounds.box_mm();
    for (const std::uint32_t n : z_order(places_mm)) {
        const Site& site = *owners[n];
        sites_.push_back({float(site.position_mm.x()), float(site.position_mm.y()), float(site.position_mm.z()), site.weight_mm});
        grain_.push_back(site.grain);
    }
    double largest_mm = 0.0;
    for (int axis = 0; axis < 3; ++axis)
        largest_mm = std::max({largest_mm, std::abs(box_mm.min()[axis]), std::abs(box_mm.max()[axis])});
    placement_.rounding_mm = real(0.5 * roundings * double(std::numeric_limits<real>::epsilon()) * largest_mm);
    keep_visible(bounds);
    find_neighbors(bounds);
    fill_start_grid(box_mm);
}

void CellData::keep_visible(const ConvexBounds& bounds) {
    std::vector<char> hidden(sites_.size(), 0);
    {
        const SiteTree tree(sites_);
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sites_.size(), sites_per_task), [&](const auto& range) {
            CellNeighborSearch search(sites_, tree, bounds);
            for (std::size_t n = range.begin(); n < range.end(); ++n) hidden[n] = search.is_hidden(std::uint32_t(n)) ? 1 : 0;
        });
    }
    std::size_t kept = 0;
    for (std::size_t n = 0; n < sites_.size(); ++n) {
        if (hidden[n] != 0) continue;
        sites_[kept] = sites_[n];
        grain_[kept++] = grain_[n];
    }
    sites_.resize(kept);
    grain_.resize(kept);
}

void CellData::find_neighbors(const ConvexBounds& bounds) {
    const SiteTree tree(sites_);
    std::vector<std::vector<std::int32_t>> lists(sites_.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sites_.size(), sites_per_task), [&](const auto& range) {
        CellNeighborSearch search(sites_, tree, bounds);
        for (std::size_t n = range.begin(); n < range.end(); ++n) search.find(std::uint32_t(n), lists[n]);
    });
    first_.push_back(0);
    for (const std::vector<std::int32_t>& list : lists) {
        neighbors_.insert(neighbors_.end(), list.begin(), list.end());
        first_.push_back(std::uint32_t(neighbors_.size()));
    }
    neighbors_.resize(neighbors_.size() + OPAL_CELL_LANES - 1, 0);
    neighbors_.shrink_to_fit();
}

void CellData::fill_start_grid(const openvdb::BBoxd& box_mm) {
    const openvdb::Vec3d extents_mm = box_mm.extents();
    const double volume_mm3 = extents_mm.x() * extents_mm.y() * extents_mm.z();
    const double edge_mm = std::max(std::cbrt(volume_mm3 * sites_per_start_box / double(sites_.size())),
                                    1.0e-3 * std::max({extents_mm.x(), extents_mm.y(), extents_mm.z()}));
    placement_.boxes_per_mm = float(1.0 / edge_mm);
    placement_.grid_origin = {float(box_mm.min().x()), float(box_mm.min().y()), float(box_mm.min().z())};
    for (int axis = 0; axis < 3; ++axis) placement_.boxes[axis] = std::max(1, int(std::ceil(extents_mm[axis] / edge_mm)));
    const int nx = placement_.boxes[0], ny = placement_.boxes[1], nz = placement_.boxes[2];
    start_site_.assign(std::size_t(nx) * ny * nz, 0);
    const CellField cells = field();
    tbb::parallel_for(0, ny * nz, [&](int row) {
        int cell = 0;
        for (int x = 0; x < nx; ++x) {
            const Vec3 middle =
                cells.grid_origin + float(edge_mm) * Vec3{float(x) + 0.5f, float(row % ny) + 0.5f, float(row / ny) + 0.5f};
            cell = locate_cell(cells, middle, cell);
            start_site_[std::size_t(row) * nx + x] = cell;
        }
    });
}

CellField CellData::field() const {
    CellField field = placement_;
    field.sites = sites_.data();
    field.grain = grain_.data();
    field.first = first_.data();
    field.neighbors = neighbors_.data();
    field.start_site = start_site_.data();
    field.num_sites = int(sites_.size());
    return field;
}

std::size_t CellData::size_bytes() const {
    return sites_.size() * (sizeof(CellSite) + sizeof(std::int32_t)) + first_.size() * sizeof(std::uint32_t) +
           (neighbors_.size() + start_site_.size()) * sizeof(std::int32_t);
}

std::vector<float> grain_sizes_mm(const CellField& cells, const openvdb::FloatGrid& shape, std::size_t num_grains) {
    const openvdb::CoordBBox voxels = shape.evalActiveVoxelBoundingBox();
    const openvdb::Vec3d low_mm = shape.indexToWorld(voxels.min()), extents_mm = shape.indexToWorld(voxels.max()) - low_mm;
    const double volume_mm3 = extents_mm.x() * extents_mm.y() * extents_mm.z();
    const double places = std::clamp(places_per_site * cells.num_sites, fewest_places, most_places);
    const double step_mm = std::cbrt(volume_mm3 / places);
    int count[3];
    for (int axis = 0; axis < 3; ++axis) count[axis] = std::max(1, int(std::ceil(extents_mm[axis] / step_mm)));
    // Sums of whole numbers: the same in any order.
    std::vector<std::atomic<std::uint64_t>> places_in(num_grains);
    tbb::parallel_for(0, count[2], [&](int z) {
        auto accessor = shape.getConstAccessor();
        for (int y = 0; y < count[1]; ++y) {
            int cell = -1;
            for (int x = 0; x < count[0]; ++x) {
                const openvdb::Vec3d place_mm = low_mm + step_mm * openvdb::Vec3d(x + 0.5, y + 0.5, z + 0.5);
                if (!(accessor.getValue(openvdb::Coord::round(shape.worldToIndex(place_mm))) < 0.0f)) continue;
                const Vec3 place{float(place_mm.x()), float(place_mm.y()), float(place_mm.z())};
                cell = locate_cell(cells, place, cell < 0 ? nearby_cell(cells, place) : cell);
                const std::int32_t grain = cells.grain[cell];
                places_in[std::size_t(grain) - 1].fetch_add(1, std::memory_order_relaxed);
            }
        }
    });
    const double place_mm3 = step_mm * step_mm * step_mm;
    std::vector<float> sizes_mm;
    for (const std::uint64_t in_grain : places_in)
        sizes_mm.push_back(float(std::cbrt(6.0 / units::pi * double(std::max<std::uint64_t>(1, in_grain)) * place_mm3)));
    return sizes_mm;
}

}  // namespace opal
