// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/density_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "formats/error.h"
#include "formats/opal_asset_io.h"
#include "formats/text.h"

namespace opal {
namespace {

/// Along an object. The skin of its box alone is half a gigabyte then.
constexpr int most_voxels = 1024;

openvdb::FloatGrid::Ptr read_density(const MediumDescription& medium) {
    const RawOpalFile raw = read_raw_opal_file(medium.density_file);
    std::vector<std::string> names;
    for (const openvdb::GridBase::Ptr& base : raw.grids) {
        const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(base);
        if (!grid) continue;
        if (medium.density_grid.empty() || grid->getName() == medium.density_grid) return grid;
        names.push_back(grid->getName());
    }
    throw InputError(fmt::format("{}: no grid of floats{} (grids of floats: {}){}", medium.density_file.string(),
                                 medium.density_grid.empty() ? "" : " named '" + medium.density_grid + "'",
                                 names.empty() ? "none" : join(names), did_you_mean(medium.density_grid, names)));
}

/// Uniform scale and translation: all that lookups know.
void require_upright(const openvdb::FloatGrid& grid, const std::string& file) {
    const openvdb::Vec3d origin = grid.indexToWorld(openvdb::Vec3d(0.0));
    const double edge_mm = grid.voxelSize().x();
    for (int axis = 0; axis < 3; ++axis) {
        openvdb::Vec3d expected(0.0), step(0.0);
        expected[axis] = edge_mm;
        step[axis] = 1.0;
        if (!grid.transform().isLinear() || !((grid.indexToWorld(step) - origin - expected).length() < 1.0e-6 * edge_mm))
            throw InputError(
                fmt::format("{}: grid {}: rotated, or voxels with unequal edges; allowed: a uniform scale and a "
                            "translation (place the object instead)",
                            file, grid.getName()));
    }
}

}  // namespace

DensityField::DensityField(const MediumDescription& medium, const openvdb::BBoxd& bounds_mm, MajorantKind majorants,
                           TrackingKind tracking, const std::array<double, num_medium_fields>& per_mm) {
    const std::string file = medium.density_file.string();
    const openvdb::FloatGrid::Ptr density = read_density(medium)->deepCopy();
    require_upright(*density, file);
    if (!(density->background() >= 0.0f && std::isfinite(density->background())))
        throw InputError(
            fmt::format("{}: grid {}: background {}; allowed: numbers from 0", file, density->getName(), density->background()));
    const openvdb::Vec3d voxels = bounds_mm.extents() / density->voxelSize().x();
    if (!(std::max({voxels.x(), voxels.y(), voxels.z()}) <= most_voxels))
        throw InputError(fmt::format("{}: grid {}: {:.3g} voxels along the object's longest side; allowed: up to {}", file,
                                     density->getName(), std::max({voxels.x(), voxels.y(), voxels.z()}), most_voxels));
    // Everything that a lookup in the body may read counts for the bounds, the background among it.
    const openvdb::CoordBBox read(openvdb::Coord::floor(density->worldToIndex(bounds_mm.min())).offsetBy(-1),
                                  openvdb::Coord::ceil(density->worldToIndex(bounds_mm.max())).offsetBy(1));
    openvdb::MaskTree mask;
    mask.sparseFill(read, true, true);
    density->tree().topologyUnion(mask);
    density->tree().topologyIntersection(mask);

    data_ = std::make_unique<FieldGridData>(*density);
    const MediumFieldGrids grids = {density, nullptr, density};
    majorants_ = std::make_unique<MajorantGrid>(MajorantGrid::chosen(grids, bounds_mm, majorants, tracking, per_mm));
    const std::string name = density->getName();
    check_majorants(grids, majorants_->view(), {name.c_str(), name.c_str(), name.c_str()}, file);
}

void DensityField::attach(MediumView& view) const {
    view.fields[int(MediumField::sigma_a_scale)] = data_->view();
    view.fields[int(MediumField::sigma_s_mie)] = data_->view();
    view.majorants = majorants_->view();
}

}  // namespace opal
