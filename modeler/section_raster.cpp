// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/section_raster.h"

#include <fmt/format.h>
#include <openvdb/tools/Interpolation.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "formats/command.h"
#include "formats/error.h"
#include "modeler/point_grid.h"

namespace opal {
namespace {

using Samples = openvdb::tools::GridSampler<openvdb::FloatGrid::ConstAccessor, openvdb::tools::BoxSampler>;

/// The id at a point: that of the voxel it lies in, or of the nearest labelled one around it where the outline, which is smooth,
/// reaches beyond the voxels. 0 where there is none.
std::int32_t grain_at(const openvdb::Int32Grid& grid, openvdb::Int32Grid::ConstAccessor& ids, const openvdb::Vec3d& point_mm) {
    const openvdb::Vec3d position = grid.worldToIndex(point_mm);
    const openvdb::Coord voxel = openvdb::Coord::round(position);
    const std::int32_t id = ids.getValue(voxel);
    if (id != 0) return id;
    std::int32_t nearest_id = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (int n = 0; n < 27; ++n) {
        const openvdb::Coord neighbour = voxel.offsetBy(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
        const std::int32_t neighbour_id = ids.getValue(neighbour);
        const double squared = (neighbour.asVec3d() - position).lengthSqr();
        if (neighbour_id == 0 || squared >= nearest) continue;
        nearest = squared;
        nearest_id = neighbour_id;
    }
    return nearest_id;
}

/// Weight of the site nearest to a point.
class NearestWeight {
  public:
    explicit NearestWeight(const OpalAsset& asset) : sites_(asset.sites) {
        std::vector<openvdb::Vec3d> positions_mm;
        for (const Site& site : sites_) positions_mm.push_back(site.position_mm);
        const openvdb::Vec3d extents_mm = voxel_bounds_mm(asset).extents();
        spacing_mm_ = std::cbrt(extents_mm.product() / static_cast<double>(sites_.size()));
        grid_ = std::make_unique<PointGrid>(positions_mm, spacing_mm_);
    }

    float operator()(const openvdb::Vec3d& point_mm) const {
        std::size_t nearest = sites_.size();
        double nearest_mm2 = std::numeric_limits<double>::infinity();
        for (double radius_mm = spacing_mm_; nearest == sites_.size(); radius_mm *= 2.0)
            grid_->for_each_within(point_mm, radius_mm, [&](std::size_t index, double squared_mm2) {
                if (squared_mm2 > nearest_mm2 || (squared_mm2 == nearest_mm2 && index > nearest)) return;
                nearest_mm2 = squared_mm2;
                nearest = index;
            });
        return sites_[nearest].weight_mm;
    }

  private:
    const std::vector<Site>& sites_;
    double spacing_mm_ = 1.0;
    std::unique_ptr<PointGrid> grid_;
};

openvdb::FloatGrid::ConstPtr field_grid(const OpalAsset& asset, SectionColor color) {
    switch (color) {
        case SectionColor::weight:
            return asset.weight;
        case SectionColor::sigma_a_scale:
            return asset.sigma_a_scale;
        case SectionColor::sigma_s_rayleigh:
            return asset.sigma_s_rayleigh_400nm;
        case SectionColor::sigma_s_mie:
            return asset.sigma_s_mie;
        default:
            return nullptr;
    }
}

void require_field(const OpalAsset& asset, SectionColor color) {
    if (!is_field(color) || field_grid(asset, color)) return;
    if (color == SectionColor::weight) {
        if (!asset.sites.empty()) return;
        throw InputError("no grid weight and no sites, so there are no weights to show");
    }
    throw InputError(fmt::format("no grid {}: in this opal it does not vary from place to place",
                                 section_color_names()[static_cast<std::size_t>(color)]));
}

}  // namespace

const std::vector<std::string>& section_color_names() {
    static const std::vector<std::string> names = {"grain",
                                                   "orientation",
                                                   "sites",
                                                   "weight",
                                                   grid_names::sigma_a_scale,
                                                   grid_names::sigma_s_rayleigh,
                                                   grid_names::sigma_s_mie};
    return names;
}

bool is_field(SectionColor color) {
    return color >= SectionColor::weight;
}

openvdb::Vec3d SectionFrame::point_mm(double column, double row) const {
    openvdb::Vec3d point;
    point[axis] = at_mm;
    point[across] = left_mm + column * pixel_mm;
    point[up] = top_mm - row * pixel_mm;
    return point;
}

openvdb::Vec3d SectionFrame::pixel_of(const openvdb::Vec3d& point_mm) const {
    return {(point_mm[across] - left_mm) / pixel_mm, (top_mm - point_mm[up]) / pixel_mm, point_mm[axis] - at_mm};
}

SectionRange section_range_mm(const OpalAsset& asset, int axis) {
    const openvdb::CoordBBox voxels = asset.grain_id->evalActiveVoxelBoundingBox();
    return {asset.grain_id->indexToWorld(voxels.min())[axis], asset.grain_id->indexToWorld(voxels.max())[axis]};
}

openvdb::BBoxd voxel_bounds_mm(const OpalAsset& asset) {
    const openvdb::CoordBBox voxels = asset.grain_id->evalActiveVoxelBoundingBox();
    const openvdb::Vec3d half(0.5);
    return {asset.grain_id->indexToWorld(voxels.min().asVec3d() - half),
            asset.grain_id->indexToWorld(voxels.max().asVec3d() + half)};
}

SectionFrame centered_frame(const OpalAsset& asset, int axis, double at_mm, double pixel_mm, int width, int height) {
    SectionFrame frame;
    frame.axis = axis;
    frame.across = axis == 0 ? 1 : 0;
    frame.up = axis == 2 ? 1 : 2;
    frame.at_mm = at_mm;
    frame.pixel_mm = pixel_mm;
    frame.width = width;
    frame.height = height;
    const openvdb::Vec3d center_mm = voxel_bounds_mm(asset).getCenter();
    frame.left_mm = center_mm[frame.across] - 0.5 * width * pixel_mm;
    frame.top_mm = center_mm[frame.up] + 0.5 * height * pixel_mm;
    return frame;
}

SectionRaster sample_section(const OpalAsset& asset, const SectionFrame& frame, SectionColor color, int oversampling) {
    require_field(asset, color);
    SectionRaster raster;
    raster.width = frame.width * oversampling;
    raster.height = frame.height * oversampling;
    raster.oversampling = oversampling;
    const std::size_t count = raster.index(0, raster.height);
    raster.label.assign(count, 0);
    if (is_field(color)) raster.value.assign(count, 0.0f);

    const openvdb::FloatGrid::ConstPtr field = field_grid(asset, color);
    const std::unique_ptr<NearestWeight> nearest_weight =
        is_field(color) && !field ? std::make_unique<NearestWeight>(asset) : nullptr;
    tbb::parallel_for(0, raster.height, [&](int row) {
        if (interrupt_requested()) return;
        openvdb::Int32Grid::ConstAccessor ids = asset.grain_id->getConstAccessor();
        const openvdb::FloatGrid::ConstAccessor distances = asset.shape->getConstAccessor();
        const Samples distance(distances, asset.shape->transform());
        const openvdb::FloatGrid::ConstAccessor values = (field ? *field : *asset.shape).getConstAccessor();
        const Samples value(values, (field ? *field : *asset.shape).transform());
        for (int column = 0; column < raster.width; ++column) {
            const openvdb::Vec3d point_mm = frame.point_mm((column + 0.5) / oversampling, (row + 0.5) / oversampling);
            if (distance.wsSample(point_mm) >= 0.0f) continue;
            const std::size_t n = raster.index(column, row);
            raster.label[n] = is_field(color) ? 1 : grain_at(*asset.grain_id, ids, point_mm);
            if (field)
                raster.value[n] = value.wsSample(point_mm);
            else if (nearest_weight)
                raster.value[n] = (*nearest_weight)(point_mm);
        }
    });
    throw_if_interrupted();
    return raster;
}

std::vector<SectionLine> trace_lines(const SectionRaster& raster, double half_width) {
    std::vector<SectionLine> lines(raster.label.size(), SectionLine::none);
    // A disc of the line's width at each side between two samples: its middle lies half a sample from both.
    const auto draw = [&](int column, int row, bool to_the_right, SectionLine line) {
        const double radius = line == SectionLine::outline ? 2.0 * half_width : half_width;
        const int reach = static_cast<int>(std::ceil(radius)) + 1;
        const double middle_x = column + (to_the_right ? 0.5 : 0.0), middle_y = row + (to_the_right ? 0.0 : 0.5);
        for (int y = std::max(0, row - reach); y <= std::min(raster.height - 1, row + reach); ++y)
            for (int x = std::max(0, column - reach); x <= std::min(raster.width - 1, column + reach); ++x)
                if ((x - middle_x) * (x - middle_x) + (y - middle_y) * (y - middle_y) <= radius * radius)
                    lines[raster.index(x, y)] = std::max(lines[raster.index(x, y)], line);
    };
    for (int row = 0; row < raster.height; ++row)
        for (int column = 0; column < raster.width; ++column) {
            const std::int32_t here = raster.label[raster.index(column, row)];
            const auto compare = [&](int other_column, int other_row, bool to_the_right) {
                const std::int32_t other = raster.label[raster.index(other_column, other_row)];
                if (other != here)
                    draw(column, row, to_the_right, here == 0 || other == 0 ? SectionLine::outline : SectionLine::grain_boundary);
            };
            if (column + 1 < raster.width) compare(column + 1, row, true);
            if (row + 1 < raster.height) compare(column, row + 1, false);
        }
    return lines;
}

}  // namespace opal
