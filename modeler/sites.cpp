// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/sites.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "formats/error.h"
#include "modeler/lattice_sites.h"
#include "modeler/sample_cells.h"
#include "modeler/sample_elimination.h"
#include "modeler/shape_sampler.h"
#include "modeler/site_file.h"

namespace opal {
namespace {

constexpr std::size_t candidates_per_site = 5;
/// Of many sites, the shortest distance among so many is a good start for the search among all.
constexpr std::size_t few_sites = 1024;

void measure_distances(const std::vector<openvdb::Vec3d>& distinct_mm, SiteSet& sites) {
    const double packed_mm = 2.0 * packing_radius(sites.region_volume_mm3, sites.positions_mm.size());
    double typical_mm = packed_mm;
    if (distinct_mm.size() > 4 * few_sites) {
        // Clustered sites may be far closer together than evenly spread ones would be.
        std::vector<openvdb::Vec3d> some;
        for (std::size_t n = 0; n < distinct_mm.size(); n += distinct_mm.size() / few_sites) some.push_back(distinct_mm[n]);
        typical_mm = std::min(typical_mm, shortest_distance(some, packed_mm));
    }
    sites.shortest_distance_mm = shortest_distance(distinct_mm, typical_mm);
    sites.relative_radius = sites.shortest_distance_mm / packed_mm;
}

SiteSet poisson_disk_sites(const Shape& shape, SiteRegion region, std::size_t count, std::uint64_t seed) {
    const std::size_t num_candidates = candidates_per_site * count;
    const bool in_shape = region == SiteRegion::shape;
    ShapeSamples candidates = sample_uniformly(shape, in_shape ? num_candidates : 0, seed);
    if (!in_shape) candidates.positions_mm = sample_box(shape.bounds_mm(), num_candidates, seed);

    SiteSet sites;
    sites.shape_volume_mm3 = candidates.shape_volume_mm3;
    sites.region_volume_mm3 = in_shape ? candidates.shape_volume_mm3 : shape.bounds_mm().volume();
    const double r_max_mm = packing_radius(sites.region_volume_mm3, count);
    for (const std::size_t survivor : eliminate_samples(candidates.positions_mm, count, r_max_mm))
        sites.positions_mm.push_back(candidates.positions_mm[survivor]);
    measure_distances(sites.positions_mm, sites);
    return sites;
}

SiteSet sites_on_lattice(const Shape& shape, const GrainsRecipe& grains) {
    SiteSet sites;
    sites.shape_volume_mm3 = sample_uniformly(shape, 0, grains.seed).shape_volume_mm3;
    LatticeSites lattice = lattice_sites(shape, grains);
    sites.region_volume_mm3 = std::pow(lattice.cell_mm, 3.0) * static_cast<double>(lattice.cells.size());
    sites.positions_mm = std::move(lattice.positions_mm);
    sites.lattice_cells = std::move(lattice.cells);
    measure_distances(sites.positions_mm, sites);
    return sites;
}

std::vector<openvdb::Vec3d> distinct(std::vector<openvdb::Vec3d> points) {
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
}

/// Sites that fill less than this part of the shape's length are in another unit than the shape; where the cells of a few of them
/// meet, far out, would take more memory to find than there is.
constexpr double least_span = 0.01;

void require_span(const Shape& shape, const std::string& file, const SiteSet& sites) {
    openvdb::BBoxd of_sites;
    for (const openvdb::Vec3d& p : sites.positions_mm) of_sites.expand(p);
    const openvdb::Vec3d extents = shape.bounds_mm().extents();
    const double span_mm = of_sites.extents()[of_sites.maxExtent()];
    const double longest_mm = std::max({extents.x(), extents.y(), extents.z()});
    if (span_mm > 0.0 && span_mm < least_span * longest_mm)
        throw InputError(
            fmt::format("sites {}: span {:.4g} mm of the shape's {:.4g} mm; allowed: from a hundredth; check "
                        "grains.sites.scale",
                        file, span_mm, longest_mm));
}

void judge_places(const Shape& shape, const std::string& file, SiteSet& sites) {
    openvdb::BBoxd near = shape.bounds_mm();
    near.expand(sites.spacing_mm());
    const std::size_t count = sites.positions_mm.size();
    const auto outside = static_cast<std::size_t>(std::count_if(sites.positions_mm.begin(), sites.positions_mm.end(),
                                                                [&](const openvdb::Vec3d& p) { return !near.isInside(p); }));
    if (outside == count) {
        const openvdb::BBoxd bounds = shape.bounds_mm();
        throw InputError(
            fmt::format("sites {}: none of the {} sites lies near the shape, which spans ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, "
                        "{:.4g}, {:.4g}) mm; check grains.sites.scale",
                        file, count, bounds.min().x(), bounds.min().y(), bounds.min().z(), bounds.max().x(), bounds.max().y(),
                        bounds.max().z()));
    }
    if (outside > 0)
        sites.warnings.push_back(fmt::format("sites {}: {} of {} sites lie more than {:.3g} mm outside the shape's bounds", file,
                                             outside, count, sites.spacing_mm()));
    if (sites.duplicates > 0)
        sites.warnings.push_back(
            fmt::format("sites {}: {} of {} sites lie at the place of an earlier one", file, sites.duplicates, count));
}

SiteSet sites_from_file(const Shape& shape, const GrainsRecipe& grains) {
    SiteSet sites;
    sites.positions_mm = read_site_file(grains.sites.file, grains.sites.file_scale);
    sites.shape_volume_mm3 = sample_uniformly(shape, 0, grains.seed).shape_volume_mm3;
    const std::size_t count = sites.positions_mm.size();
    std::vector<char> inside(count);
    tbb::parallel_for(std::size_t(0), count, [&](std::size_t n) { inside[n] = shape.contains(sites.positions_mm[n]) ? 1 : 0; });
    const auto num_inside = static_cast<double>(std::count(inside.begin(), inside.end(), char(1)));
    sites.region_volume_mm3 =
        num_inside > 0.0 ? sites.shape_volume_mm3 * static_cast<double>(count) / num_inside : shape.bounds_mm().volume();
    const std::vector<openvdb::Vec3d> distinct_mm = distinct(sites.positions_mm);
    sites.duplicates = count - distinct_mm.size();
    measure_distances(distinct_mm, sites);
    judge_places(shape, grains.sites.file.string(), sites);
    require_span(shape, grains.sites.file.string(), sites);
    return sites;
}

}  // namespace

double SiteSet::spacing_mm() const {
    return std::cbrt(region_volume_mm3 / static_cast<double>(positions_mm.size()));
}

SiteSet sample_sites(const Shape& shape, const GrainsRecipe& grains) {
    switch (grains.sites.kind) {
        case SiteKind::poisson_disk:
            return poisson_disk_sites(shape, grains.sites.region, static_cast<std::size_t>(grains.num_sites), grains.seed);
        case SiteKind::jittered_lattice:
            return sites_on_lattice(shape, grains);
        case SiteKind::file:
            return sites_from_file(shape, grains);
    }
    throw std::logic_error("a kind of sites without sites");
}

SiteSet sample_sites(const Shape& shape, std::size_t count, std::uint64_t seed) {
    return poisson_disk_sites(shape, SiteRegion::shape, count, seed);
}

}  // namespace opal
