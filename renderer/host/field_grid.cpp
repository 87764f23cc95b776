// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/field_grid.h"

#include <nanovdb/util/OpenToNanoVDB.h>

#include <optional>
#include <utility>
#include <vector>

#include "formats/error.h"

namespace opal {
namespace {

/// Boxes up to this many voxels are marked one by one; larger ones come from tiles, and stay tiles.
constexpr openvdb::Index64 voxels_marked_singly = 64;

/// Voxels of a field that interpolation reads anywhere inside a shape: in every box of a shape's voxel that the surface may cut
/// or enclose.
openvdb::MaskTree voxels_read_inside(const openvdb::FloatGrid& shape, const openvdb::math::Transform& field) {
    openvdb::MaskTree mask;
    openvdb::tree::ValueAccessor<openvdb::MaskTree> accessor(mask);
    const float reach_mm = static_cast<float>(shape.voxelSize().x());
    openvdb::CoordBBox box;
    for (auto value = shape.cbeginValueAll(); value; ++value) {
        if (!(*value < reach_mm)) continue;
        value.getBoundingBox(box);
        const openvdb::Vec3d low = field.worldToIndex(shape.indexToWorld(box.min().asVec3d() - 0.5));
        const openvdb::Vec3d high = field.worldToIndex(shape.indexToWorld(box.max().asVec3d() + 0.5));
        const openvdb::CoordBBox read(openvdb::Coord::floor(low), openvdb::Coord::ceil(high));
        if (read.volume() > voxels_marked_singly) {
            mask.sparseFill(read, true, true);
            continue;
        }
        for (auto voxel = read.begin(); voxel; ++voxel) accessor.setValueOn(*voxel);
    }
    return mask;
}

/// Mean of the neighbours that are known; none where there are none.
std::optional<float> mean_of_neighbours(const openvdb::FloatGrid::Accessor& values,
                                        const openvdb::tree::ValueAccessor<openvdb::MaskTree>& known,
                                        const openvdb::Coord& voxel) {
    double sum = 0.0;
    int count = 0;
    for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j)
            for (int k = -1; k <= 1; ++k) {
                const openvdb::Coord neighbour = voxel.offsetBy(i, j, k);
                if (!known.isValueOn(neighbour)) continue;
                sum += static_cast<double>(values.getValue(neighbour));
                ++count;
            }
    if (count == 0) return std::nullopt;
    return static_cast<float>(sum / count);
}

/// Gives `unknown` voxels the mean of their known neighbours, layer after layer.
void spread_outward(std::vector<openvdb::Coord> unknown, openvdb::MaskTree& known_mask, openvdb::FloatGrid& field) {
    openvdb::tree::ValueAccessor<openvdb::MaskTree> known(known_mask);
    auto values = field.getAccessor();
    std::vector<std::pair<openvdb::Coord, float>> layer;
    do {
        layer.clear();
        std::vector<openvdb::Coord> rest;
        for (const openvdb::Coord& voxel : unknown) {
            if (const auto mean = mean_of_neighbours(values, known, voxel))
                layer.emplace_back(voxel, *mean);
            else
                rest.push_back(voxel);
        }
        for (const auto& [voxel, value] : layer) {
            values.setValueOn(voxel, value);
            known.setValueOn(voxel);
        }
        unknown = std::move(rest);
    } while (!layer.empty());
}

}  // namespace

openvdb::FloatGrid::Ptr fit_field(const openvdb::FloatGrid& field, const openvdb::FloatGrid& shape) {
    const openvdb::MaskTree read = voxels_read_inside(shape, field.transform());
    openvdb::MaskTree missing(read);
    missing.topologyDifference(field.tree());
    openvdb::MaskTree known(read);
    known.topologyUnion(field.tree());
    const auto inside = shape.getConstAccessor();
    std::vector<openvdb::Coord> unknown;
    for (auto voxel = missing.cbeginValueOn(); voxel; ++voxel) {
        if (voxel.isTileValue()) continue;  // regions deep inside
        const openvdb::Coord place = voxel.getCoord();
        const openvdb::Vec3d in_shape = shape.worldToIndex(field.indexToWorld(place));
        if (inside.getValue(openvdb::Coord::round(in_shape)) < 0.0f) continue;
        unknown.push_back(place);
        known.setValueOff(place);
    }
    const openvdb::FloatGrid::Ptr fitted = field.deepCopy();
    fitted->tree().topologyUnion(read);
    spread_outward(std::move(unknown), known, *fitted);
    fitted->tree().topologyIntersection(read);
    return fitted;
}

struct FieldGridData::Storage {
    nanovdb::GridHandle<nanovdb::HostBuffer> handle;
    FieldView view;
};

FieldGridData::FieldGridData(const openvdb::FloatGrid& field) : storage_(std::make_unique<Storage>()) {
    storage_->handle = nanovdb::openToNanoVDB(field, nanovdb::StatsMode::BBox, nanovdb::ChecksumMode::Disable);
    const FieldGrid* grid = storage_->handle.grid<float>();
    if (!grid) throw SystemError(field.getName() + " could not be converted to NanoVDB");
    const openvdb::Vec3d origin = field.worldToIndex(openvdb::Vec3d(0.0));
    storage_->view = {grid, float(1.0 / field.voxelSize().x()), {float(origin.x()), float(origin.y()), float(origin.z())}};
}

FieldGridData::~FieldGridData() = default;
FieldGridData::FieldGridData(FieldGridData&&) noexcept = default;
FieldGridData& FieldGridData::operator=(FieldGridData&&) noexcept = default;

FieldView FieldGridData::view() const {
    return storage_->view;
}

}  // namespace opal
