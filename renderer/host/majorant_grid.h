// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "formats/scene.h"
#include "renderer/core/majorant_view.h"

namespace opal {

/// The fields of a medium as `fit_field` leaves them; null where a coefficient does not vary.
using MediumFieldGrids = std::array<openvdb::FloatGrid::ConstPtr, num_medium_fields>;

/// Bounds of the fields of a medium in the cubes of a regular grid: smallest and largest of what interpolation gives anywhere in
/// the cube (its values lie between those of the voxels it reads). A cube that no active voxel reaches holds the background.
class MajorantGrid {
  public:
    /// `longest_side` cells along the longest side of `bounds_mm` (object space), as many as it takes along the others. Built
    /// from the fields' trees: a tile counts as one box, a leaf inside one cell by its own smallest and largest value.
    MajorantGrid(const MediumFieldGrids& fields, const openvdb::BBoxd& bounds_mm, int longest_side);

    /// The grid of 1 to 64 cells along the longest side that costs least: the mean over the cells of the tentative collisions per
    /// mm, with `per_mm` the coefficients per unit of each field, against the crossings of cells per mm.
    static MajorantGrid fitted(const MediumFieldGrids& fields, const openvdb::BBoxd& bounds_mm,
                               const std::array<double, num_medium_fields>& per_mm);

    /// The grid that a scene's settings ask for: fitted or a single cell; its lower bounds 0 where what is least is not to be
    /// split off.
    static MajorantGrid chosen(const MediumFieldGrids& fields, const openvdb::BBoxd& bounds_mm, MajorantKind majorants,
                               TrackingKind tracking, const std::array<double, num_medium_fields>& per_mm);

    /// From given cells.
    MajorantGrid(std::vector<MajorantCell> cells, const MajorantView& geometry);

    const std::vector<MajorantCell>& cells() const { return cells_; }
    /// With lower bounds of 0 for the fields that vary: ratio tracking.
    MajorantGrid without_least(const MediumFieldGrids& fields) const;
    /// Valid while this object stays where it is.
    MajorantView view() const;

  private:
    /// Without values in the cells that a field does not reach.
    static MajorantGrid reached(const MediumFieldGrids& fields, const openvdb::BBoxd& bounds_mm, int longest_side);
    void fill_unreached(const MediumFieldGrids& fields);
    void add_field(int field, const openvdb::FloatGrid& grid);
    MajorantGrid coarser() const;
    double cost_per_mm(const std::array<double, num_medium_fields>& per_mm) const;

    std::vector<MajorantCell> cells_;
    MajorantView geometry_;
};

/// Throws InputError, naming grid and voxel, where an active voxel of a field is not a number from 0, or outside the bounds of a
/// cell that reads it. `names`: of the grids; `file`: for the message.
void check_majorants(const MediumFieldGrids& fields, const MajorantView& majorants,
                     const std::array<const char*, num_medium_fields>& names, const std::string& file);

}  // namespace opal
