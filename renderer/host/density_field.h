// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "formats/material.h"
#include "formats/scene.h"
#include "renderer/core/medium.h"
#include "renderer/host/field_grid.h"
#include "renderer/host/majorant_grid.h"

namespace opal {

/// The density of a dielectric's medium from place to place: a fog grid in the object's own mm, linear between the centres of its
/// voxels, the grid's background beyond them.
class DensityField {
  public:
    /// `bounds_mm`: of the body, object space. `per_mm`: absorption and scattering per unit of density and object mm, for the
    /// size of the majorants' cells. Throws InputError for a file without such a grid, densities that are no numbers from 0, and
    /// grids that are rotated or have unequal voxel edges.
    DensityField(const MediumDescription& medium, const openvdb::BBoxd& bounds_mm, MajorantKind majorants, TrackingKind tracking,
                 const std::array<double, num_medium_fields>& per_mm);

    /// Valid while this object lives.
    void attach(MediumView& view) const;

  private:
    std::unique_ptr<FieldGridData> data_;
    std::unique_ptr<MajorantGrid> majorants_;
};

}  // namespace opal
