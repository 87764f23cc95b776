// SPDX-License-Identifier: GPL-3.0-or-later
#include "stability_cells.h"

#include <fmt/format.h>

#include <ctime>
#include <numeric>

#include "cell_samples.h"
#include "formats/recipe.h"
#include "modeler/labelling.h"
#include "modeler/shape.h"
#include "modeler/sites.h"
#include "renderer/core/cell_walk.h"
#include "renderer/core/hyperboloid_walk.h"
#include "renderer/core/sphere_tracing_walk.h"
#include "renderer/host/grain_grid.h"
#include "small_opal.h"
#include "timed_render.h"

namespace opal {
namespace {

using namespace cell_samples;

constexpr std::size_t num_sites = 300;
constexpr double gem_mm = 20.0;

std::vector<GrainStretch> walk_ray(WalkKind kind, const CellField& field, Vec3 origin, Vec3 direction, float end_mm) {
    switch (kind) {
        case WalkKind::sphere_tracing:
            return walked_stretches(SphereTracingWalk(field, origin, direction), end_mm);
        case WalkKind::hyperboloid:
            return walked_stretches(HyperboloidWalk(field, origin, direction), end_mm);
        case WalkKind::cells:
            break;
    }
    return walked_stretches(CellWalk(field, origin, direction), end_mm);
}

constexpr double match_mm = 0.01;

}  // namespace

const char* name_of(WalkKind kind) {
    switch (kind) {
        case WalkKind::sphere_tracing:
            return "sphere-tracing";
        case WalkKind::hyperboloid:
            return "hyperboloid as printed";
        case WalkKind::cells:
            break;
    }
    return "cells";
}

Estimate wrong_length(WalkKind kind, double spread_mm, double offset_mm, int rays) {
    std::vector<Site> sites = random_sites(num_sites, spread_mm, 3);
    const openvdb::Vec3d offset(offset_mm, 0.0, 0.0);
    for (Site& site : sites) site.position_mm += offset;
    ConvexBounds bounds;
    for (int corner = 0; corner < 8; ++corner)
        bounds.hold(offset + half_mm * openvdb::Vec3d((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                                                      (corner & 4) != 0 ? 1.0 : -1.0));
    const CellData cells(sites, bounds);
    const CellField field = cells.field();
    Draws draws(4);
    SampleMean wrong;
    double length_mm = 0.0;
    for (int n = 0; n < rays; ++n) {
        const openvdb::Vec3d place = draws.in_cube(half_mm);
        const Vec3 direction = draws.direction();
        const float end = way_out_mm(to_vec3(place), direction);
        const Vec3 origin = to_vec3(place + offset);
        WalkErrors errors;
        add_errors(sites, origin, direction, double(end), exact_stretches(sites, origin, direction, double(end)),
                   walk_ray(kind, field, origin, direction, end), match_mm, errors);
        wrong.add(errors.wrong_mm);
        length_mm += double(end) / rays;
    }
    return {wrong.estimate().mean / length_mm, wrong.estimate().standard_error / length_mm};
}

GrazingError grazing_error(WalkKind kind, double angle_rad, int rays) {
    const std::vector<Site> sites = {{{-1.0, 0.0, 0.0}, 0.0f, 1}, {{1.0, 0.0, 0.0}, 0.0f, 2}};
    const CellData cells(sites, cube());
    const CellField field = cells.field();
    Draws draws(5);
    const float sine = float(std::sin(angle_rad)), cosine = float(std::cos(angle_rad));
    constexpr float end_mm = 12.0f;
    const Vec3 direction{sine, 0.0f, cosine};
    std::vector<Vec3> origins;
    for (int n = 0; n < rays; ++n) {
        const float before_mm = float(3.0 + 2.0 * draws.next());
        origins.push_back({-before_mm * sine, float(draws.signed_next()), -5.0f});
    }
    std::vector<std::vector<GrainStretch>> walked;
    const std::clock_t begin = std::clock();
    for (const Vec3& origin : origins) walked.push_back(walk_ray(kind, field, origin, direction, end_mm));
    const double seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
    SampleMean along;
    for (int n = 0; n < rays; ++n) {
        const double crossing_mm = -double(origins[std::size_t(n)].x) / double(direction.x);
        const GrainStretch& last = walked[std::size_t(n)].back();
        // A crossing that is not found by the ray's end counts as found there.
        along.add(std::abs((last.grain == 2 ? last.begin_mm : double(end_mm)) - crossing_mm));
    }
    const Estimate along_mm = along.estimate();
    const double s = std::sin(angle_rad);
    return {along_mm, {along_mm.mean * s, along_mm.standard_error * s}, 1.0e6 * seconds / rays};
}

std::vector<VoxelError> voxel_errors(double grain_mm, const std::vector<int>& resolutions, int rays) {
    const double ball_mm = std::max(4.0, 4.0 * grain_mm), bounds_voxel_mm = ball_mm / 32.0;
    ShapeRecipe ball;
    ball.kind = ShapeKind::sphere;
    ball.size_mm = {ball_mm, ball_mm, ball_mm};
    const auto shape = make_shape(ball);
    const openvdb::Vec3d centre_mm = shape->bounds_mm().getCenter();
    const SiteSet set = sample_sites(*shape, std::size_t(std::lround(std::pow(ball_mm / grain_mm, 3))), 1);
    std::vector<Site> sites;
    for (const openvdb::Vec3d& place : set.positions_mm) sites.push_back({place, 0.0f, std::int32_t(sites.size()) + 1});
    std::vector<std::int32_t> labels(sites.size());
    std::iota(labels.begin(), labels.end(), 1);
    ConvexBounds bounds;
    bounds.hold_inside(*shape->level_set(bounds_voxel_mm));
    bounds.widen(2.0 * bounds_voxel_mm);
    const CellData cells(sites, bounds);
    const CellField field = cells.field();
    std::vector<VoxelError> errors;
    for (const int resolution : resolutions) {
        const double voxel_mm = gem_mm / resolution;
        const GrainGridData voxels(*label_voxels(sites, labels, *shape->level_set(voxel_mm)));
        Draws draws(6);
        SampleMean wrong;
        double length_mm = 0.0;
        while (wrong.count() < std::uint64_t(rays)) {
            // Chords within the inner nine tenths: what the surface cuts is not asked about here.
            const openvdb::Vec3d place = draws.in_cube(0.45 * ball_mm);
            const Vec3 direction = draws.direction();
            const openvdb::Vec3d v(double(direction.x), double(direction.y), double(direction.z));
            const double along = place.dot(v), radius2 = std::pow(0.45 * ball_mm, 2) - place.lengthSqr();
            if (radius2 <= 0.0) continue;
            const double end_mm = std::sqrt(along * along + radius2) - along;
            const Vec3 origin = to_vec3(centre_mm + place);
            WalkErrors found;
            add_errors(sites, origin, direction, end_mm, walked_stretches(CellWalk(field, origin, direction), float(end_mm)),
                       walked_stretches(GrainWalk(voxels.field(), origin, direction), float(end_mm)), match_mm, found);
            wrong.add(found.wrong_mm);
            length_mm += end_mm / rays;
        }
        const Estimate estimate = wrong.estimate();
        errors.push_back({resolution, {estimate.mean / length_mm, estimate.standard_error / length_mm}});
    }
    return errors;
}

FarRender far_render(Place place, double offset_mm, int samples) {
    SmallOpal small;
    small.constants.sigma_s_mie_per_mm = 0.1;
    OpalAsset asset = small.make();
    const bool in_file = place == Place::moved_in_its_file;
    const openvdb::Vec3d move = in_file ? openvdb::Vec3d(offset_mm, 0.0, 0.0) : openvdb::Vec3d(0.0);
    asset.shape->transform().postTranslate(move);
    asset.grain_id->transform().postTranslate(move);
    for (Site& site : asset.sites) site.position_mm += move;
    const ScratchFolder folder;
    write_opal_asset(asset, folder / "opal.vdb");
    const double translate_mm = in_file ? -offset_mm : offset_mm, camera_mm = in_file ? 0.0 : offset_mm;
    const std::string text = fmt::format(
        "[render]\nwidth = 48\nheight = 48\nsampler = \"independent\"\nmax_bounces = 512\n[camera]\nposition_mm = [{1}, -20, 5]\n"
        "target_mm = [{1}, 0, 0]\nvertical_fov_deg = 14\n[environment]\nkind = \"constant\"\n[[object]]\nkind = \"opal\"\n"
        "translate_mm = [{0}, 0, 0]\nfile = '{2}'\n",
        translate_mm, camera_mm, (folder / "opal.vdb").string());
    const TimedRender rendered = timed_render(text, samples);
    FarRender result;
    result.notices = rendered.notices;
    const MeanEstimate green = region_mean(rendered.image, "G", 0, 0, 48, 48);
    const double n = double(rendered.outcome.totals.samples);
    result.missing = {1.0 - green.mean - rendered.outcome.totals.truncated_rgb[1] / n, green.standard_error};
    result.lost = share_of(rendered.outcome.counters.lost_paths, rendered.outcome.totals.samples);
    return result;
}

void add_weight_rows(bool quick, StabilityRows& rows) {
    const std::string unit = "share of the length in the wrong grain";
    for (const WalkKind kind : {WalkKind::cells, WalkKind::sphere_tracing, WalkKind::hyperboloid}) {
        const bool cells = kind == WalkKind::cells;
        const std::string outcome = cells ? "default; exact to rounding at any weights"
                                          : "only where opal.grains asks for it, for comparison; no word in the picture";
        const std::string test =
            cells ? "CellWalk.EqualsTheOracleOnNearlyEqualWeights" : "Stability.HyperboloidNeedsUnlikeWeights";
        for (const double spread_mm : {3.0, 1.0, 0.3, 0.1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8})
            rows.push_back({"near-equal weights", name_of(kind), "largest difference of weights (mm)", spread_mm,
                            wrong_length(kind, spread_mm, 0.0, quick ? 30 : 200), unit, outcome, test});
    }
}

void add_far_rows(bool quick, StabilityRows& rows) {
    const std::string input = "distance from the origin (mm)";
    for (const double offset_mm : {0.0, 1e2, 1e3, 1e4, 1e5, 1e6}) {
        rows.push_back({"far from the origin", "cells, opal moved in its file", input, offset_mm,
                        wrong_length(WalkKind::cells, 0.7, offset_mm, quick ? 30 : 200), "share of the length in the wrong grain",
                        "noted at load where boundaries err by more than 1 % of a grain", "Stability.CellsFarFromTheOrigin"});
        for (const Place place : {Place::moved_in_its_file, Place::whole_scene_moved}) {
            const FarRender far = far_render(place, offset_mm, quick ? 4 : 32);
            const bool in_file = place == Place::moved_in_its_file;
            const std::string method = in_file ? "furnace, opal moved in its file" : "furnace, whole scene moved";
            const std::string outcome = in_file ? "noted at load; a warning where over 0.1 % of the paths are lost"
                                                : "nothing to be done: places count from where the camera looks";
            const std::string test =
                in_file ? "Stability.OpalsFarFromTheirFilesOriginAreNoted" : "Stability.ScenesFarFromTheOriginLoseNoLight";
            rows.push_back({"far from the origin",
                            method,
                            input,
                            offset_mm,
                            {std::abs(far.missing.mean), far.missing.standard_error},
                            "light missing from 1",
                            outcome,
                            test});
            rows.push_back({"far from the origin", method, input, offset_mm, far.lost, "share of paths lost", outcome, test});
        }
    }
}

void add_grazing_rows(bool quick, StabilityRows& rows) {
    for (const WalkKind kind : {WalkKind::sphere_tracing, WalkKind::cells, WalkKind::hyperboloid})
        for (const double angle_rad : {1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5}) {
            const GrazingError error = grazing_error(kind, angle_rad, quick ? 40 : 400);
            const std::string input = "angle to the boundary (rad)";
            const std::string outcome =
                kind == WalkKind::cells ? "default" : "only where opal.grains asks for it; no word in the picture";
            const std::string test = "Stability.GrazingBoundaries";
            rows.push_back({"grazing boundaries", name_of(kind), input, angle_rad, error.along_mm,
                            "error of a crossing along the ray (mm)", outcome, test});
            rows.push_back({"grazing boundaries", name_of(kind), input, angle_rad, error.across_mm,
                            "error of a crossing across the boundary (mm)", outcome, test});
            rows.push_back({"grazing boundaries",
                            name_of(kind),
                            input,
                            angle_rad,
                            {error.us_per_ray, 0.0},
                            "processor time per ray (us)",
                            outcome,
                            test});
        }
}

void add_voxel_rows(bool quick, StabilityRows& rows) {
    const std::vector<double> grains_mm = quick ? std::vector<double>{0.3, 1.0, 3.0} : std::vector<double>{0.1, 0.3, 1.0, 3.0};
    const std::vector<int> resolutions = quick ? std::vector<int>{64, 128, 256} : std::vector<int>{64, 128, 256, 512, 1024};
    for (const double grain_mm : grains_mm)
        for (const VoxelError& error : voxel_errors(grain_mm, resolutions, quick ? 100 : 600))
            rows.push_back({"voxels across 20 mm", fmt::format("voxels, grains of {} mm", grain_mm), "voxels across 20 mm",
                            double(error.resolution), error.wrong, "share of the length in the wrong grain",
                            "cells are taken instead where the file holds its sites; else noted below 6 voxels per grain",
                            "Stability.VoxelsMislabelInProportionToTheirSize"});
}

}  // namespace opal
