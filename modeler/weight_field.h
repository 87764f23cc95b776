// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <memory>
#include <vector>

#include "formats/recipe.h"
#include "modeler/point_grid.h"
#include "modeler/shape.h"
#include "modeler/sites.h"

namespace opal {

/// The weight of a place before weights are limited: the sum of a recipe's terms. A term is its amplitude times
///  - perlin, simplex: fractal noise of the place over scale_mm, in [-1, 1]; each term's is independent of the others'
///  - linear:   how far along `direction`, from -1 at the first site to 1 at the last
///  - radial:   how far from center_mm, from -1 at the nearest site to 1 at the farthest
///  - distance: how deep below the surface, from -1 at the surface and outside to 1 at the deepest site
///  - grid:     a float grid's value, interpolated linearly
///  - csv:      a number per site; of a place, the nearest site's
/// The first five are also multiplied by the sites' shortest distance and so are in mm, as the values of grids and csv files are.
/// The multiplicative tessellation leaves that factor out, so its field has no unit. The voronoi tessellation's field is 0.
class WeightField {
  public:
    /// Reads the files that the terms name. Throws InputError for files that cannot be used, for a csv whose length is not the
    /// number of sites, and for noise too fine for the shape's size. `sites` and `shape` must outlive the field.
    WeightField(const GrainsRecipe& recipe, const SiteSet& sites, const Shape& shape);

    double at_site(std::size_t site) const;
    double at(const openvdb::Vec3d& place_mm) const;

    /// Whether it is the same everywhere because nothing in the recipe lets it vary.
    bool is_constant() const { return terms_.empty(); }
    /// Size of the smallest features, mm.
    double feature_mm() const;

  private:
    struct Term {
        WeightTerm recipe;
        double factor = 0.0;            ///< amplitude, with the shortest distance where that counts
        std::uint32_t first_block = 0;  ///< of its noise
        double low = 0.0, high = 0.0;   ///< linear, radial, distance: what is scaled to -1 and to 1
        openvdb::FloatGrid::ConstPtr grid;
        std::vector<double> values;
    };

    Term make_term(const WeightTerm& recipe, std::uint32_t number, bool without_unit) const;
    double measure(const Term& term, const openvdb::Vec3d& place_mm) const;
    double value(const Term& term, const openvdb::Vec3d& place_mm) const;
    std::size_t nearest_site(const openvdb::Vec3d& place_mm) const;

    const SiteSet& sites_;
    const Shape& shape_;
    std::uint64_t seed_;
    std::vector<Term> terms_;
    std::unique_ptr<PointGrid> site_grid_;  ///< only for csv terms
};

}  // namespace opal
