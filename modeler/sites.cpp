// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/sites.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "formats/command.h"
#include "formats/error.h"
#include "formats/random.h"
#include "modeler/sample_cells.h"
#include "modeler/sample_elimination.h"

namespace opal {
namespace {

constexpr std::size_t candidates_per_site = 5;
/// Few sites still need a fair estimate of the volume.
constexpr std::size_t min_hits_for_volume = 10'000;
constexpr std::size_t tries_per_batch = 1 << 16;
/// A shape that fills less than this part of its bounds is refused.
constexpr double min_fill = 1.0e-4;

openvdb::Vec3d uniform_point(const openvdb::BBoxd& bounds_mm, std::uint64_t seed, std::size_t try_number) {
    const RandomBlock low = random_block(seed, RandomStream::site_candidates, try_number, 0);
    const RandomBlock high = random_block(seed, RandomStream::site_candidates, try_number, 1);
    const openvdb::Vec3d unit(uniform_double(low.value[0], low.value[1]), uniform_double(low.value[2], low.value[3]),
                              uniform_double(high.value[0], high.value[1]));
    return bounds_mm.min() + unit * bounds_mm.extents();
}

struct Samples {
    std::vector<openvdb::Vec3d> positions_mm;
    double shape_volume_mm3 = 0.0;
};

Samples sample_uniformly(const Shape& shape, std::size_t count, std::uint64_t seed) {
    const openvdb::BBoxd bounds_mm = shape.bounds_mm();
    const std::size_t wanted_hits = std::max(count, min_hits_for_volume);
    const auto max_tries = static_cast<std::size_t>(static_cast<double>(wanted_hits) / min_fill);
    Samples samples;
    std::size_t hits = 0, tries = 0;
    std::vector<openvdb::Vec3d> points(tries_per_batch);
    std::vector<char> inside(tries_per_batch);
    while (hits < wanted_hits) {
        throw_if_interrupted();
        if (tries >= max_tries || (tries >= 10'000'000 && static_cast<double>(hits) < min_fill * static_cast<double>(tries)))
            throw InputError(fmt::format(
                "shape: fills too little of its bounds to place sites in: {} of {} random points were inside", hits, tries));
        tbb::parallel_for(std::size_t(0), tries_per_batch, [&](std::size_t n) {
            points[n] = uniform_point(bounds_mm, seed, tries + n);
            inside[n] = shape.contains(points[n]) ? 1 : 0;
        });
        for (std::size_t n = 0; n < tries_per_batch && hits < wanted_hits; ++n, ++tries) {
            if (inside[n] == 0) continue;
            if (hits < count) samples.positions_mm.push_back(points[n]);
            ++hits;
        }
    }
    samples.shape_volume_mm3 = bounds_mm.volume() * static_cast<double>(hits) / static_cast<double>(tries);
    return samples;
}

}  // namespace

double SiteSet::spacing_mm() const {
    return std::cbrt(shape_volume_mm3 / static_cast<double>(positions_mm.size()));
}

SiteSet sample_sites(const Shape& shape, std::size_t count, std::uint64_t seed) {
    const Samples candidates = sample_uniformly(shape, candidates_per_site * count, seed);
    const double r_max_mm = packing_radius(candidates.shape_volume_mm3, count);

    SiteSet sites;
    sites.shape_volume_mm3 = candidates.shape_volume_mm3;
    for (const std::size_t survivor : eliminate_samples(candidates.positions_mm, count, r_max_mm))
        sites.positions_mm.push_back(candidates.positions_mm[survivor]);
    sites.shortest_distance_mm = shortest_distance(sites.positions_mm, 2.0 * r_max_mm);
    sites.relative_radius = sites.shortest_distance_mm / (2.0 * r_max_mm);
    return sites;
}

}  // namespace opal
