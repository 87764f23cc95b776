// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/weights.h"

#include <fmt/format.h>
#include <openvdb/tools/Prune.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/error.h"
#include "modeler/point_grid.h"
#include "modeler/weight_field.h"

namespace opal {
namespace {

/// Exponents beyond this leave the range of a float.
constexpr double max_exponent = 80.0;
/// Limited weights stay this much, relatively, below the limit, so that rounding does not carry them over it.
constexpr double limit_margin = 0x1p-20;
constexpr double max_weight_grid_size = 128.0;

double weight_from_field(double field, TessellationKind tessellation) {
    return tessellation == TessellationKind::multiplicative ? std::exp(-field) : field;
}

void require_usable(double field, TessellationKind tessellation, std::size_t site) {
    const bool multiplicative = tessellation == TessellationKind::multiplicative;
    const double largest = multiplicative ? max_exponent : static_cast<double>(std::numeric_limits<float>::max());
    if (!(std::abs(field) <= largest))
        throw InputError(fmt::format("grains.weight: site {} gets {:.6g}{}; allowed: up to {:.4g}", site + 1, field,
                                     multiplicative ? ", whose exponential is its factor" : " mm", largest));
}

/// Largest difference between the weights of neighbours.
double largest_difference_mm(const std::vector<Site>& sites, const PointGrid& grid, double neighbour_distance_mm) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, sites.size()), 0.0,
        [&](const tbb::blocked_range<std::size_t>& range, double largest_mm) {
            for (std::size_t n = range.begin(); n != range.end(); ++n)
                grid.for_each_within(sites[n].position_mm, neighbour_distance_mm, [&](std::size_t other, double) {
                    largest_mm = std::max(largest_mm, std::abs(static_cast<double>(sites[n].weight_mm) -
                                                               static_cast<double>(sites[other].weight_mm)));
                });
            return largest_mm;
        },
        [](double a, double b) { return std::max(a, b); });
}

/// Scales the weights until no neighbours differ by `limit_mm` or more; returns the factor.
double limit_weights(std::vector<Site>& sites, const SiteSet& set) {
    const double limit_mm = set.shortest_distance_mm;
    const auto [least, most] =
        std::minmax_element(sites.begin(), sites.end(), [](const Site& a, const Site& b) { return a.weight_mm < b.weight_mm; });
    if (!(limit_mm > 0.0) || static_cast<double>(most->weight_mm) - static_cast<double>(least->weight_mm) < limit_mm) return 1.0;
    const double neighbour_distance_mm = 2.0 * set.spacing_mm();
    const PointGrid grid(set.positions_mm, neighbour_distance_mm);
    const std::vector<Site> unlimited = sites;
    double scale = 1.0;
    for (double difference_mm = largest_difference_mm(sites, grid, neighbour_distance_mm); difference_mm >= limit_mm;
         difference_mm = largest_difference_mm(sites, grid, neighbour_distance_mm)) {
        scale *= (1.0 - limit_margin) * limit_mm / difference_mm;
        for (std::size_t n = 0; n < sites.size(); ++n)
            sites[n].weight_mm = static_cast<float>(scale * static_cast<double>(unlimited[n].weight_mm));
    }
    return scale;
}

}  // namespace

WeighedSites weigh_sites(const SiteSet& sites, const GrainsRecipe& recipe, const Shape& shape) {
    const WeightField field(recipe, sites, shape);
    WeighedSites weighed;
    weighed.sites.resize(sites.positions_mm.size());
    tbb::parallel_for(std::size_t(0), weighed.sites.size(), [&](std::size_t n) {
        const double value = field.at_site(n);
        require_usable(value, recipe.tessellation, n);
        weighed.sites[n].position_mm = sites.positions_mm[n];
        weighed.sites[n].weight_mm = static_cast<float>(weight_from_field(value, recipe.tessellation));
    });
    if (recipe.limit_weights && recipe.tessellation != TessellationKind::multiplicative && !weighed.sites.empty())
        weighed.weight_scale = limit_weights(weighed.sites, sites);
    return weighed;
}

openvdb::FloatGrid::Ptr make_weight_grid(const SiteSet& sites, const GrainsRecipe& recipe, const Shape& shape,
                                         double weight_scale) {
    const WeightField field(recipe, sites, shape);
    if (field.is_constant()) return nullptr;
    const openvdb::BBoxd bounds_mm = shape.bounds_mm();
    const openvdb::Vec3d extents_mm = bounds_mm.extents();
    const double longest_mm = std::max({extents_mm.x(), extents_mm.y(), extents_mm.z()});
    const double voxel_size_mm = std::max(0.25 * field.feature_mm(), longest_mm / max_weight_grid_size);

    const auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setName(grid_names::weight);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel_size_mm));
    openvdb::CoordBBox voxels(openvdb::Coord::floor(bounds_mm.min() / voxel_size_mm),
                              openvdb::Coord::ceil(bounds_mm.max() / voxel_size_mm));
    voxels.expand(2);
    grid->tree().denseFill(voxels, 0.0f, false);
    std::vector<openvdb::FloatTree::LeafNodeType*> leaves;
    grid->tree().getNodes(leaves);
    tbb::parallel_for(std::size_t(0), leaves.size(), [&](std::size_t n) {
        for (auto voxel = leaves[n]->beginValueOff(); voxel; ++voxel) {
            const openvdb::Vec3d place_mm = voxel.getCoord().asVec3d() * voxel_size_mm;
            if (shape.signed_distance_mm(place_mm) > std::sqrt(3.0) * voxel_size_mm) continue;
            const double value = weight_from_field(weight_scale * field.at(place_mm), recipe.tessellation);
            leaves[n]->setValueOn(voxel.pos(), static_cast<float>(value));
        }
    });
    openvdb::tools::pruneInactive(grid->tree());
    return grid;
}

}  // namespace opal
