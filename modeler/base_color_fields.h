// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <functional>

#include "formats/opal_asset.h"
#include "formats/recipe.h"
#include "modeler/shape.h"

namespace opal {

/// Grains of all voxels where a level set is negative: the labelling with everything but the level set decided.
using GrainLabeller = std::function<openvdb::Int32Grid::Ptr(const openvdb::FloatGrid& level_set)>;

/// Sets the asset's fields sigma_a_scale (a factor), sigma_s_rayleigh_400nm and sigma_s_mie (mm^-1): coefficient times factor,
/// with the factor at x
///  - noise: 1 + contrast n(x / scale), n fractal gradient noise in [-1, 1], another one for each field;
///  - layers: 1 + contrast sin(2 pi d.x / scale), d the unit direction;
///  - grains: 1 + contrast (2 u - 1), u uniform in [0, 1) for each grain and field;
///  - grid: the user's float grid at the world place x in mm, interpolated linearly; its background counts.
/// Factors are never negative, so coefficient (1 + contrast) bounds the first three from above.
///
/// Each field has voxels of its own size: voxel_size_mm, or as coarse as it allows: a quarter of the finest octave's cell, 1/16
/// of a layer's period, the labels' voxels for grains, the user's grid's own; never finer than the labels' voxels, never coarser
/// than 1/16 of the shape's longest side. Active are the voxels nearer to the shape than sqrt(3) of a voxel, so that
/// interpolation at no place inside reads the background 0; regions of one value are tiles. The same recipe gives the same bits
/// on any number of threads.
///
/// A field that does not vary (contrast 0, coefficient 0, a user's constant grid, a single grain) gives no grid: its constant
/// goes into the asset's coefficient. Needs the asset's level set, seed and constants. Throws InputError for user's grids that
/// are missing, negative or NaN (naming grid and voxel), and for voxel sizes that take too many voxels; Interrupted on Ctrl-C.
void add_base_color_fields(const BaseColorRecipe& recipe, const Shape& shape, const GrainLabeller& label, OpalAsset& asset);

}  // namespace opal
