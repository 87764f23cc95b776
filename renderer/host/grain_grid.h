// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <memory>
#include <vector>

#include "renderer/core/grain_walk.h"

namespace opal {

/// Owns a NanoVDB copy of grain_id, the form that the transport walks on host and device.
class GrainGridData {
  public:
    explicit GrainGridData(const openvdb::Int32Grid& grain_id);
    ~GrainGridData();
    GrainGridData(GrainGridData&&) noexcept;
    GrainGridData& operator=(GrainGridData&&) noexcept;

    GrainField field() const;
    std::size_t size_bytes() const;

  private:
    struct Storage;
    std::unique_ptr<Storage> storage_;
};

/// Diameter (mm) of a ball as large as each grain, from the number of its voxels; element g - 1 is grain g's. A grain without
/// voxels is given one voxel's.
std::vector<float> grain_sizes_mm(const openvdb::Int32Grid& grain_id, std::size_t num_grains);

}  // namespace opal
