// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/weight_field.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/error.h"
#include "modeler/float_grid_file.h"
#include "modeler/gradient_noise.h"
#include "modeler/number_list.h"
#include "modeler/simplex_noise.h"

namespace opal {
namespace {

/// Beyond this many cells from the origin too few places in a cell are told apart.
constexpr double max_lattice_coordinate = 0x1p40;
/// Linear, radial and distance terms are as long as the shape; this part of it is taken for their features.
constexpr double plain_feature_fraction = 0.125;

bool is_noise(WeightKind kind) {
    return kind == WeightKind::perlin || kind == WeightKind::simplex;
}

bool is_from_file(WeightKind kind) {
    return kind == WeightKind::grid || kind == WeightKind::csv;
}

double longest_side_mm(const Shape& shape) {
    const openvdb::Vec3d extents_mm = shape.bounds_mm().extents();
    return std::max({extents_mm.x(), extents_mm.y(), extents_mm.z()});
}

std::vector<double> read_site_values(const std::filesystem::path& file, std::size_t num_sites) {
    std::vector<double> values = read_number_list(file);
    if (values.size() != num_sites)
        throw InputError(fmt::format("{}: {} values for {} sites; one per site is needed, in the sites' order", file.string(),
                                     values.size(), num_sites));
    return values;
}

void require_resolvable_noise(const WeightTerm& term, const Shape& shape) {
    const openvdb::BBoxd bounds_mm = shape.bounds_mm();
    const double farthest_mm = std::max(bounds_mm.min().length(), bounds_mm.max().length());
    if (!(std::ldexp(farthest_mm / term.scale_mm, term.octaves) <= max_lattice_coordinate))
        throw InputError(fmt::format("grains.weight.scale_mm {}: too small for a shape of this size", term.scale_mm));
}

}  // namespace

WeightField::WeightField(const GrainsRecipe& recipe, const SiteSet& sites, const Shape& shape)
    : sites_(sites), shape_(shape), seed_(recipe.seed) {
    if (recipe.tessellation == TessellationKind::voronoi) return;
    for (const WeightTerm& term : recipe.weight)
        if (term.kind != WeightKind::none)
            terms_.push_back(make_term(term, static_cast<std::uint32_t>(terms_.size()),
                                       recipe.tessellation == TessellationKind::multiplicative));
    const auto is_csv = [](const Term& term) { return term.recipe.kind == WeightKind::csv; };
    if (std::any_of(terms_.begin(), terms_.end(), is_csv))
        site_grid_ = std::make_unique<PointGrid>(sites.positions_mm, sites.spacing_mm());
}

WeightField::Term WeightField::make_term(const WeightTerm& recipe, std::uint32_t number, bool without_unit) const {
    Term term;
    term.recipe = recipe;
    term.first_block = number * max_octaves;
    term.factor = recipe.amplitude * (without_unit || is_from_file(recipe.kind) ? 1.0 : sites_.shortest_distance_mm);
    if (is_noise(recipe.kind)) {
        require_resolvable_noise(recipe, shape_);
    } else if (recipe.kind == WeightKind::grid) {
        term.grid = read_float_grid(recipe.file, recipe.grid);
    } else if (recipe.kind == WeightKind::csv) {
        term.values = read_site_values(recipe.file, sites_.positions_mm.size());
    } else {
        term.low = recipe.kind == WeightKind::distance ? 0.0 : std::numeric_limits<double>::infinity();
        term.high = recipe.kind == WeightKind::distance ? 0.0 : -std::numeric_limits<double>::infinity();
        std::vector<double> measures(sites_.positions_mm.size());
        tbb::parallel_for(std::size_t(0), measures.size(),
                          [&](std::size_t n) { measures[n] = measure(term, sites_.positions_mm[n]); });
        for (const double m : measures) {
            term.low = std::min(term.low, m);
            term.high = std::max(term.high, m);
        }
    }
    return term;
}

/// What a linear, radial or distance term grows with, in mm.
double WeightField::measure(const Term& term, const openvdb::Vec3d& place_mm) const {
    if (term.recipe.kind == WeightKind::linear) return openvdb::Vec3d(term.recipe.direction.data()).unit().dot(place_mm);
    if (term.recipe.kind == WeightKind::radial) return (place_mm - openvdb::Vec3d(term.recipe.center_mm.data())).length();
    return std::max(0.0, -shape_.signed_distance_mm(place_mm));
}

double WeightField::value(const Term& term, const openvdb::Vec3d& place_mm) const {
    const NoiseSource perlin{seed_, RandomStream::perlin_gradients, term.first_block};
    const NoiseSource simplex{seed_, RandomStream::simplex_gradients, term.first_block};
    switch (term.recipe.kind) {
        case WeightKind::perlin:
            return fractal_noise(place_mm / term.recipe.scale_mm, perlin, term.recipe.octaves);
        case WeightKind::simplex:
            return fractal_simplex_noise(place_mm / term.recipe.scale_mm, simplex, term.recipe.octaves);
        case WeightKind::grid:
            return sample_float_grid(*term.grid, place_mm, term.recipe.file);
        case WeightKind::csv:
            return term.values[nearest_site(place_mm)];
        default:
            if (!(term.high > term.low)) return 0.0;
            return 2.0 * (measure(term, place_mm) - term.low) / (term.high - term.low) - 1.0;
    }
}

double WeightField::at(const openvdb::Vec3d& place_mm) const {
    double sum = 0.0;
    for (const Term& term : terms_) sum += term.factor * value(term, place_mm);
    return sum;
}

double WeightField::at_site(std::size_t site) const {
    double sum = 0.0;
    for (const Term& term : terms_)
        sum += term.factor * (term.recipe.kind == WeightKind::csv ? term.values[site] : value(term, sites_.positions_mm[site]));
    return sum;
}

double WeightField::feature_mm() const {
    double smallest_mm = plain_feature_fraction * longest_side_mm(shape_);
    for (const Term& term : terms_) {
        double feature_mm = smallest_mm;
        if (is_noise(term.recipe.kind)) feature_mm = std::ldexp(term.recipe.scale_mm, 1 - term.recipe.octaves);
        if (term.recipe.kind == WeightKind::grid) feature_mm = 4.0 * term.grid->voxelSize().x();
        if (term.recipe.kind == WeightKind::csv) feature_mm = sites_.spacing_mm();
        smallest_mm = std::min(smallest_mm, feature_mm);
    }
    return smallest_mm;
}

std::size_t WeightField::nearest_site(const openvdb::Vec3d& place_mm) const {
    std::size_t nearest = 0;
    double smallest_mm2 = std::numeric_limits<double>::infinity();
    for (double radius_mm = sites_.spacing_mm(); !(smallest_mm2 < std::numeric_limits<double>::infinity()); radius_mm *= 2.0)
        site_grid_->for_each_within(place_mm, radius_mm, [&](std::size_t site, double squared_mm2) {
            if (squared_mm2 < smallest_mm2 || (squared_mm2 == smallest_mm2 && site < nearest)) {
                smallest_mm2 = squared_mm2;
                nearest = site;
            }
        });
    return nearest;
}

}  // namespace opal
