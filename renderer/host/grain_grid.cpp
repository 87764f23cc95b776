// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/grain_grid.h"

#include <nanovdb/util/OpenToNanoVDB.h>

#include <algorithm>
#include <cmath>

#include "formats/error.h"
#include "formats/units.h"

namespace opal {

struct GrainGridData::Storage {
    nanovdb::GridHandle<nanovdb::HostBuffer> handle;
    GrainField field;
};

GrainGridData::GrainGridData(const openvdb::Int32Grid& grain_id) : storage_(std::make_unique<Storage>()) {
    // The walk uses values alone; statistics and checksums would only cost time.
    storage_->handle = nanovdb::openToNanoVDB(grain_id, nanovdb::StatsMode::BBox, nanovdb::ChecksumMode::Disable);
    const GrainGrid* grid = storage_->handle.grid<std::int32_t>();
    if (!grid) throw SystemError("grain_id could not be converted to NanoVDB");
    const openvdb::Vec3d origin = grain_id.worldToIndex(openvdb::Vec3d(0.0));
    storage_->field = {grid, float(1.0 / grain_id.voxelSize().x()), {float(origin.x()), float(origin.y()), float(origin.z())}};
}

GrainGridData::~GrainGridData() = default;
GrainGridData::GrainGridData(GrainGridData&&) noexcept = default;
GrainGridData& GrainGridData::operator=(GrainGridData&&) noexcept = default;

std::vector<float> grain_sizes_mm(const openvdb::Int32Grid& grain_id, std::size_t num_grains) {
    std::vector<std::uint64_t> voxels(num_grains, 0);
    for (auto value = grain_id.cbeginValueOn(); value; ++value)
        if (*value > 0) voxels[std::size_t(*value) - 1] += value.getVoxelCount();
    const double voxel_mm3 = grain_id.transform().voxelVolume();
    std::vector<float> sizes_mm;
    for (const std::uint64_t count : voxels)
        sizes_mm.push_back(float(std::cbrt(6.0 / units::pi * double(std::max<std::uint64_t>(1, count)) * voxel_mm3)));
    return sizes_mm;
}

GrainField GrainGridData::field() const {
    return storage_->field;
}
std::size_t GrainGridData::size_bytes() const {
    return storage_->handle.size();
}

}  // namespace opal
