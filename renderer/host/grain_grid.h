// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <memory>

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

}  // namespace opal
