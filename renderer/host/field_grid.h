// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <memory>

#include "renderer/core/field_lookup.h"

namespace opal {

/// A copy of a field whose active voxels are exactly those that interpolation inside the level set can read. A voxel that the
/// field leaves inactive keeps its value (the background) where its centre is inside the shape: the file says so. Outside the
/// shape nothing is said, and fading into the background would darken or brighten a skin of one voxel: there the voxel takes the
/// mean of its neighbours (26) that are known, layer after layer. Lookups then need not ask which voxels are active. Both
/// transforms: uniform scale and translation.
openvdb::FloatGrid::Ptr fit_field(const openvdb::FloatGrid& field, const openvdb::FloatGrid& shape);

/// Owns a NanoVDB copy of a field, the form that the transport reads on host and device.
class FieldGridData {
  public:
    explicit FieldGridData(const openvdb::FloatGrid& field);
    ~FieldGridData();
    FieldGridData(FieldGridData&&) noexcept;
    FieldGridData& operator=(FieldGridData&&) noexcept;

    FieldView view() const;

  private:
    struct Storage;
    std::unique_ptr<Storage> storage_;
};

}  // namespace opal
