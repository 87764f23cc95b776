// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <vector>

#include "modeler/shape.h"

namespace opal {

/// Sites one to a cell of a cubic lattice, in the order of their cells (z fastest).
struct LatticeSites {
    std::vector<openvdb::Vec3d> positions_mm;
    std::vector<openvdb::Coord> cells;  ///< counted from 0 along each axis
    double cell_mm = 0.0;               ///< edge of a cell
};

/// Exactly `grains.num_sites` sites in cells of a cubic lattice that is centred on the shape's bounds. Along side e of the bounds
/// there are n = round(e / cell) cells (at least one), `cell` being the edge that fits the n best (least squares over the sides).
/// For region bounds all n_x n_y n_z cells count, for region shape those whose centre is inside the shape. Of the lattices with
/// at least num_sites cells the coarsest is taken; where it has more than that, the cells whose centres lie deepest inside the
/// shape (or least far outside) get the sites, of equals those that come first. A cube and n^3 sites give n x n x n cells.
///
/// A site is uniform in the part `grains.sites.jitter` of its cell, about its centre, that lies within the bounds; for region
/// shape it is drawn anew, up to eight times, until it is inside the shape, else it is the centre. It is a pure function of
/// (seed, cell). Throws InputError where no lattice of up to 2^20 cells along a side has that many cells.
LatticeSites lattice_sites(const Shape& shape, const GrainsRecipe& grains);

}  // namespace opal
