// SPDX-License-Identifier: GPL-3.0-or-later
#include "grains_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>

#include "cell_oracle.h"
#include "formats/command.h"
#include "formats/random.h"
#include "formats/recipe.h"
#include "modeler/labelling.h"
#include "modeler/shape.h"
#include "modeler/sites.h"
#include "modeler/weights.h"
#include "renderer/core/cell_walk.h"
#include "renderer/core/hyperboloid_walk.h"
#include "renderer/core/sphere_tracing_walk.h"
#include "renderer/host/cell_data.h"
#include "renderer/host/grain_grid.h"

namespace opal {
namespace {

constexpr float radius_mm = 10.0f;
constexpr double seconds_per_row = 0.5;
constexpr int rays_per_batch = 200;

struct Chord {
    Vec3 origin, direction;
    float length_mm;
};

/// Chord number `index` of a ball, isotropic, from a hair inside.
Chord chord_of_ball(Vec3 centre, std::uint64_t index) {
    const RandomBlock block = random_block(1, RandomStream::bench, index, 0);
    const float z = 2.0f * uniform_float(block.value[0]) - 1.0f, azimuth = 2.0f * pi_f * uniform_float(block.value[1]);
    const float sine = std::sqrt(1.0f - z * z);
    const Vec3 direction{sine * std::cos(azimuth), sine * std::sin(azimuth), z};
    const float offset_mm = 0.99f * radius_mm * std::sqrt(uniform_float(block.value[2]));
    const float turn = 2.0f * pi_f * uniform_float(block.value[3]);
    const Frame frame(direction);
    const float half_mm = std::sqrt(radius_mm * radius_mm - offset_mm * offset_mm) - 0.01f;
    const Vec3 middle = offset_mm * (std::cos(turn) * frame.tangent + std::sin(turn) * frame.bitangent);
    return {centre + middle - half_mm * direction, direction, 2.0f * half_mm};
}

class GrainsBench {
  public:
    std::vector<GrainsBenchRow> run(bool quick) {
        measure_sites("additive", 1000, {128, 256, 512});
        measure_sites("voronoi", 1000, {512});
        measure_sites("nearly-equal", 1000, {512});
        measure_sites("strong", 1000, {512});
        if (!quick) measure_sites("additive", 27000, {128, 256, 512});
        return std::move(rows_);
    }

  private:
    Chord chord(std::uint64_t index) const { return chord_of_ball(centre_, index); }

    void place_sites(const std::string& weights, std::size_t count) {
        // Amplitudes are the largest deviation; sites are 1.6 and 0.54 mm apart.
        const double spacing_mm = 16.1 / std::cbrt(double(count));
        const double amplitude_mm =
            weights == "additive" ? 0.3 * spacing_mm : (weights == "nearly-equal" ? 1.0e-5 : (weights == "strong" ? 3.0 : 0.0));
        std::string text = fmt::format(
            "[shape]\nkind = \"sphere\"\nsize_mm = 20\n[grains]\nnum_sites = {}\nvoxel_size_mm = 0.1\nlimit_weights = false\n",
            count);
        text += weights == "voronoi" ? "tessellation = \"voronoi\"\n"
                                     : fmt::format("weight = {{ kind = \"perlin\", amplitude = {}, scale_mm = {} }}\n",
                                                   amplitude_mm, 2.0 * spacing_mm);
        const Recipe recipe = parse_recipe(text, "recipe.toml", {});
        shape_ = make_shape(recipe.shape);
        const openvdb::Vec3d centre_mm = shape_->bounds_mm().getCenter();
        centre_ = {float(centre_mm.x()), float(centre_mm.y()), float(centre_mm.z())};
        sites_ = weigh_sites(sample_sites(*shape_, recipe.grains), recipe.grains, *shape_).sites;
        for (std::size_t n = 0; n < sites_.size(); ++n) sites_[n].grain = std::int32_t(n) + 1;
        exact_.clear();
        const int rays = count > 10000 ? 40 : 300;
        for (int n = 0; n < rays; ++n) {
            const Chord ray = chord(std::uint64_t(n));
            exact_.push_back(exact_stretches(sites_, ray.origin, ray.direction, double(ray.length_mm)));
        }
    }

    void measure_sites(const std::string& weights, std::size_t count, const std::vector<int>& resolutions) {
        place_sites(weights, count);
        GrainsBenchRow row;
        row.weights = weights;
        row.sites = count;
        ConvexBounds bounds;
        bounds.hold_inside(*shape_->level_set(0.1));
        bounds.widen(0.2);
        const Stopwatch watch;
        const CellData cells(sites_, bounds);
        const double build_s = watch.seconds();
        const CellField field = cells.field();
        const auto with_cells = [&](const char* method) {
            GrainsBenchRow filled = row;
            filled.method = method;
            filled.bytes = cells.size_bytes();
            filled.build_s = build_s;
            return filled;
        };
        measure<CellWalk>(field, with_cells("cells"));
        measure<SphereTracingWalk>(field, with_cells("sphere-tracing"));
        measure<HyperboloidWalk>(field, with_cells("hyperboloid"));
        for (const int resolution : resolutions) measure_voxels(resolution, row);
    }

    void measure_voxels(int resolution, GrainsBenchRow row) {
        std::vector<std::int32_t> labels(sites_.size());
        std::iota(labels.begin(), labels.end(), 1);
        const auto level_set = shape_->level_set(2.0 * double(radius_mm) / resolution);
        const Stopwatch watch;
        const GrainGridData voxels(*label_voxels(sites_, labels, *level_set));
        row.build_s = watch.seconds();
        row.method = "voxels";
        row.voxels_across = resolution;
        row.bytes = voxels.size_bytes();
        measure<GrainWalk>(voxels.field(), row);
    }

    template <class Walk, class Field>
    void measure(const Field& field, GrainsBenchRow row) {
        WalkErrors errors;
        for (std::size_t n = 0; n < exact_.size(); ++n) {
            const Chord ray = chord(n);
            const auto walked = walked_stretches(Walk(field, ray.origin, ray.direction), ray.length_mm);
            add_errors(sites_, ray.origin, ray.direction, double(ray.length_mm), exact_[n], walked,
                       0.25 * 16.1 / std::cbrt(double(row.sites)), errors);
        }
        row.crossings = errors.crossings;
        row.missed = errors.missed;
        row.spurious = errors.spurious;
        row.wrong_length = errors.wrong_mm / errors.length_mm;
        row.mean_error_um = 1.0e3 * errors.error_sum_mm / std::max<double>(1.0, double(errors.crossings - errors.missed));
        row.largest_error_um = 1.0e3 * errors.largest_error_mm;

        // The grains crossed are those of the oracle: a walk that finds too many is not the faster for it.
        std::uint64_t crossed = 0;
        double length_mm = 0.0;
        for (std::size_t n = 0; n < exact_.size(); ++n) {
            crossed += exact_[n].size();
            length_mm += double(chord(n).length_mm);
        }
        const double grains_per_mm = double(crossed) / length_mm;
        double walked_mm = 0.0, seconds = 0.0;
        std::uint64_t index = 0;
        std::vector<Chord> rays(rays_per_batch);
        while (seconds < seconds_per_row) {
            for (Chord& ray : rays) ray = chord(index++);
            const std::clock_t begin = std::clock();
            for (const Chord& ray : rays) {
                Walk walk(field, ray.origin, ray.direction);
                float distance = 0.0f;
                int grain = 0;
                while ((grain = walk.next_grain(grain, distance, ray.length_mm)) != 0) checksum_ += std::uint64_t(grain);
                walked_mm += double(ray.length_mm);
            }
            seconds += double(std::clock() - begin) / CLOCKS_PER_SEC;
        }
        row.ns_per_grain = 1.0e9 * seconds / (walked_mm * grains_per_mm);
        rows_.push_back(row);
        fmt::print(
            "{:<12} {:>6} {:<14} {:>4} {:>7.1f} ns {:>8.3f} MB, built in {:>6.3f} s; of {} crossings missed {}, spurious {}; "
            "{:.2e} of the length wrong; error {:.3g} um mean, {:.3g} um at most\n",
            row.weights, row.sites, row.method, row.voxels_across, row.ns_per_grain, 1.0e-6 * double(row.bytes), row.build_s,
            row.crossings, row.missed, row.spurious, row.wrong_length, row.mean_error_um, row.largest_error_um);
        std::fflush(stdout);
    }

    std::unique_ptr<Shape> shape_;
    Vec3 centre_;
    std::vector<Site> sites_;
    std::vector<std::vector<GrainStretch>> exact_;
    std::vector<GrainsBenchRow> rows_;
    std::uint64_t checksum_ = 0;  ///< keeps the walks from being optimized away
};

}  // namespace

std::vector<GrainsBenchRow> bench_grains(bool quick) {
    return GrainsBench().run(quick);
}

}  // namespace opal
