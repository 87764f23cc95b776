// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <vector>

#include "formats/opal_asset.h"
#include "formats/recipe.h"
#include "modeler/shape.h"
#include "modeler/sites.h"

namespace opal {

struct WeighedSites {
    std::vector<Site> sites;
    double weight_scale = 1.0;  ///< by which all weights were multiplied to limit them
};

/// Sites with the weights that their tessellation asks for: values of the WeightField in mm; for the multiplicative one the
/// factors m_i = exp(-field_i), so that a larger field gives a larger grain there too. Weights are rounded to the float that the
/// file holds before anything is computed from them.
///
/// Where the recipe says limit_weights, and neighbours (pairs nearer than twice the mean spacing, the edge of a cube of a site's
/// share of the volume) differ by the sites' shortest distance r or more, all weights are multiplied by one factor so that
/// |w_i - w_j| < r holds for all neighbours. Factors m_i hide no site and are left alone; so are the weights of sites that share
/// a place, for which r is 0. Throws InputError for weights out of a float's range, and as WeightField does.
WeighedSites weigh_sites(const SiteSet& sites, const GrainsRecipe& recipe, const Shape& shape);

/// The field that the sites' weights were taken from, in their unit: a fog volume named `weight` whose voxels are a quarter of
/// the smallest feature wide, or as much wider as keeps the longest side at 128 of them. Active in the shape and a voxel's
/// diagonal around it, 0 elsewhere. Null for a field that does not vary.
openvdb::FloatGrid::Ptr make_weight_grid(const SiteSet& sites, const GrainsRecipe& recipe, const Shape& shape,
                                         double weight_scale);

}  // namespace opal
