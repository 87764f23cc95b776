// SPDX-License-Identifier: GPL-3.0-or-later
#include "stability_media.h"

#include <fmt/format.h>

#include "formats/scene.h"
#include "goniometer.h"
#include "renderer/core/medium_flight.h"
#include "renderer/host/medium_fields.h"
#include "small_opal.h"
#include "timed_render.h"

namespace opal {
namespace {

constexpr double ball_radius_mm = 3.0;

/// Majorants of the fields that vary, times a factor; minima as they are, or lower where they would pass them.
MajorantGrid scaled(const MajorantGrid& grid, const MediumView& medium, float factor) {
    std::vector<MajorantCell> cells = grid.cells();
    for (MajorantCell& cell : cells)
        for (int f = 0; f < num_medium_fields; ++f) {
            if (!medium.fields[f].grid) continue;
            cell.max[f] *= factor;
            cell.min[f] = std::min(cell.min[f], cell.max[f]);
        }
    return MajorantGrid(std::move(cells), grid.view());
}

}  // namespace

Estimate plate_transmission_ratio(double optical_depth, int paths) {
    SmallOpal small;
    small.radius_mm = 2.0;
    small.half_thickness_mm = 0.5;
    small.grains = 1;
    small.constants.n_sphere = 1.5;
    small.constants.n_medium = 1.5;
    small.constants.sigma_a_per_mm = absorber_spectrum("neutral", optical_depth);
    const ScratchFolder folder;
    write_opal_asset(small.make(), folder / "plate.vdb");
    write_cap(folder / "below.exr", {0.0f, 0.0f, -1.0f}, 60.0);
    const Goniometer goniometer("[environment]\nfile = '" + (folder / "below.exr").string() +
                                    "'\n[opal]\ndiffraction = \"none\"\n[[object]]\nkind = \"opal\"\nfile = '" +
                                    (folder / "plate.vdb").string() + "'\n",
                                1.5);
    const double face = 0.04, passed = std::exp(-optical_depth);
    const double expected = (1.0 - face) * (1.0 - face) * passed / (1.0 - face * face * passed * passed);
    const Goniometer::Reading reading = goniometer.radiance({0.0f, 0.0f, -1.0f}, 0.1, 550.0, paths, 1);
    if (expected < 1.0e-37) return {reading.mean < 1.0e-37 ? 1.0 : 0.0, 0.0};
    return {reading.mean / expected, reading.standard_error / expected};
}

ScatteringBall scattering_ball(double optical_depth, int max_bounces, int samples) {
    SmallOpal small;
    small.radius_mm = ball_radius_mm;
    small.grains = 1;
    small.constants.sigma_s_mie_per_mm = optical_depth / (2.0 * ball_radius_mm);
    small.constants.mie_asymmetry = 0.0;
    const ScratchFolder folder;
    write_opal_asset(small.make(), folder / "ball.vdb");
    const std::string text = fmt::format(
        "[render]\nwidth = 16\nheight = 16\nsampler = \"independent\"\nfilter = \"box\"\nmax_bounces = {}\n[camera]\n"
        "position_mm = [0, -20, 5]\ntarget_mm = [0, 0, 0]\nvertical_fov_deg = 8\n[environment]\nkind = \"constant\"\n[opal]\n"
        "diffraction = \"none\"\n[[object]]\nkind = \"opal\"\nfile = '{}'\n",
        max_bounces, (folder / "ball.vdb").string());
    const TimedRender rendered = timed_render(text, samples);
    const MeanEstimate green = region_mean(rendered.image, "G", 0, 0, 16, 16);
    const std::uint64_t n = rendered.outcome.totals.samples;
    ScatteringBall result;
    result.missing = {1.0 - green.mean, green.standard_error};
    const double truncated = rendered.outcome.totals.truncated_rgb[1] / double(n);
    result.truncated = {truncated, std::sqrt(std::max(0.0, truncated * (1.0 - truncated)) / double(n))};
    result.cut_off = share_of(rendered.outcome.counters.truncated_paths, n);
    result.scatterings = double(rendered.outcome.counters.scatterings) / double(n);
    result.us_per_path = rendered.processor_us_per_path();
    return result;
}

MajorantEffect majorant_effect(double factor, int flights) {
    SmallOpal small;
    small.grains = 1;
    small.constants.sigma_a_per_mm = absorber_spectrum("neutral", 0.1);
    small.fields[0] = [](const auto& p) { return 1.0 + 0.9 * std::sin(2.0 * p.z()) * std::cos(p.x()); };
    small.fields[2] = [](const auto& p) { return 0.3 + 0.25 * std::sin(3.0 * p.z()); };
    const OpalAsset asset = small.make();
    const MediumFields fields(asset, MajorantKind::local, 1.0, "bench");
    OpalView opal;
    fields.attach(opal.medium);
    const MajorantGrid changed = scaled(*fields.majorants(), opal.medium, float(factor));
    opal.medium.majorants = changed.view();
    LaneMedium<1> medium;
    medium.sigma_a.v[0] = 0.1f;
    medium.sigma_mie.v[0] = 1.0f;
    const Ray ray{{0.2f, -0.1f, -2.8f}, {0.0f, 0.28f, 0.96f}};
    constexpr float way_mm = 5.5f;

    double depth = 0.0;
    constexpr int steps = 20000;
    for (int k = 0; k < steps; ++k) {
        const Vec3 place = ray.origin + (way_mm * (float(k) + 0.5f) / float(steps)) * ray.direction;
        depth += double(way_mm) / steps *
                 (0.1 * double(field_value(opal.medium.fields[0], place)) + double(field_value(opal.medium.fields[2], place)));
    }
    const double expected = std::exp(-depth);

    SampleMean passed;
    std::uint64_t violations = 0;
    const double begin = processor_seconds();
    for (int n = 0; n < flights; ++n) {
        PathRandom random(9, 1, std::uint32_t(n));
        LaneWeights<1> weights;
        MediumFlight<1> flight(opal, medium, ray, weights, random, violations);
        flight.advance(way_mm, weights);
        passed.add(flight.scattered() ? 0.0 : double(weights.throughput.v[0]) / expected);
    }
    const double seconds = processor_seconds() - begin;
    const Estimate ratio = passed.estimate();
    const double per_flight = double(violations) / flights;
    return {{ratio.mean - 1.0, ratio.standard_error}, {per_flight, std::sqrt(per_flight / flights)}, 1.0e6 * seconds / flights};
}

void add_depth_rows(bool quick, StabilityRows& rows) {
    const std::string input = "optical depth";
    for (const double depth : {1e-3, 1e-2, 0.1, 1.0, 10.0, 30.0, 80.0, 1e2, 1e3, 1e4}) {
        const Estimate ratio = plate_transmission_ratio(depth, quick ? 500 : 5000);
        rows.push_back({"optical depth",
                        "absorbing plate, closed form",
                        input,
                        depth,
                        {std::abs(ratio.mean - 1.0), ratio.standard_error},
                        "relative error of what passes",
                        "closed form along the way; 0 beyond a float's range (depth 87)",
                        "Stability.PlatesOfAnyOpticalDepth"});
    }
    for (const int bounces : {64, 10000})
        for (const double depth : {1e-3, 1e-2, 0.1, 1.0, 3.0, 10.0, 30.0, 100.0, 1e3, 1e4}) {
            // Deep balls with many bounces: thousands of scatterings per path.
            const int samples = (quick ? 2 : 16) * (bounces > 64 && depth > 50.0 ? 1 : 8);
            if (quick && bounces > 64 && depth > 200.0) continue;
            const ScatteringBall ball = scattering_ball(depth, bounces, samples);
            const std::string method = fmt::format("white scattering ball, {} bounces", bounces);
            const std::string outcome = "reported (truncated_rgb); a warning where over 1 % of the paths are cut off",
                              test = "Furnace.TruncationIsReported; Stability.ScatteringBallsOfAnyDepthKeepTheirLight";
            const auto add = [&](Estimate error, const std::string& unit) {
                rows.push_back({"optical depth", method, input, depth, error, unit, outcome, test});
            };
            add(ball.truncated, "share of the light cut off");
            add({std::abs(ball.missing.mean - ball.truncated.mean),
                 std::hypot(ball.missing.standard_error, ball.truncated.standard_error)},
                "light neither shown nor reported as cut off");
            add({ball.scatterings, 0.0}, "scatterings per path");
            add({ball.us_per_path, 0.0}, "processor time per path (us)");
        }
}

void add_majorant_rows(bool quick, StabilityRows& rows) {
    for (const double factor : {0.3, 0.5, 0.7, 0.8, 0.9, 0.99, 1.0, 1.5, 2.0, 5.0, 10.0, 30.0, 100.0}) {
        const MajorantEffect effect = majorant_effect(factor, quick ? 5000 : 100000);
        const bool small = factor < 1.0;
        const std::string outcome = small ? "cannot come from a file (checked at load); counted, and a warning asks to report it"
                                          : "no bias, more time",
                          test = small
                                     ? "MediumFlight.ViolationsAreCounted; MajorantGrid.BoundsEveryPlaceAndVoxelAtEveryWavelength"
                                     : "MediumFlight.LooseMajorantsChangeNothingButTime";
        const auto add = [&](Estimate error, const std::string& unit) {
            rows.push_back({"majorants", "residual tracking", "majorant over the right one", factor, error, unit, outcome, test});
        };
        add({std::abs(effect.error.mean), effect.error.standard_error}, "relative error of what passes");
        add(effect.violations, "violations counted per flight");
        add({effect.us_per_flight, 0.0}, "processor time per flight (us)");
    }
}

void add_bounce_rows(bool quick, StabilityRows& rows) {
    // Milky opal: 5 scatterings per mm.
    for (const int bounces : {8, 16, 32, 64, 128, 256, 512, 1024, 4096, 10000}) {
        const ScatteringBall ball = scattering_ball(30.0, bounces, quick ? 8 : 64);
        const auto add = [&](Estimate error, const std::string& unit) {
            rows.push_back({"bounces", "milky ball, 5 scatterings per mm, 6 mm", "render.max_bounces", double(bounces), error,
                            unit,
                            "truncated_rgb and per wavelength in --stats; a warning where over 1 % of the paths are cut off",
                            "Furnace.TruncationIsReported; Stability.TruncatedLightIsReportedAtAnyBounceLimit"});
        };
        add(ball.missing, "light missing from 1");
        add(ball.truncated, "share of the light reported as cut off");
        add(ball.cut_off, "share of the paths cut off");
        add({ball.us_per_path, 0.0}, "processor time per path (us)");
    }
}

}  // namespace opal
