// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "../formats/expect_error.h"
#include "formats/scene.h"
#include "formats/units.h"
#include "power_law.h"
#include "renderer/host/grain_source.h"
#include "renderer/host/host_scene.h"
#include "renderer/host/render_warnings.h"
#include "renderer/optics/two_beam_block.h"
#include "small_opal.h"
#include "stability_cells.h"
#include "stability_media.h"
#include "stability_percolation.h"
#include "stability_planes.h"
#include "stability_spectra.h"
#include "three_beam.h"

namespace opal {
namespace {

bool mentions(const std::vector<std::string>& texts, const std::string& part) {
    return std::any_of(texts.begin(), texts.end(), [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

/// The printed quadratic loses crossings where weights are nearly equal; the factored one and sphere tracing do not.
TEST(Stability, HyperboloidNeedsUnlikeWeights) {
    const Estimate unlike = wrong_length(WalkKind::hyperboloid, 3.0, 0.0, 60),
                   alike = wrong_length(WalkKind::hyperboloid, 1.0e-4, 0.0, 60);
    EXPECT_GT(alike.mean, 0.04);
    EXPECT_LT(unlike.mean, 0.1 * alike.mean);
    for (const double spread_mm : {3.0, 1.0e-4}) {
        EXPECT_LT(wrong_length(WalkKind::cells, spread_mm, 0.0, 60).mean, 1.0e-5);
        EXPECT_LT(wrong_length(WalkKind::sphere_tracing, spread_mm, 0.0, 60).mean, 1.0e-4);
    }
}

/// Errors grow as the rounding of the coordinates: some half-ulps at each crossing, of which there are fewer than one per mm.
TEST(Stability, CellsFarFromTheOrigin) {
    for (const double offset_mm : {0.0, 1.0e3, 1.0e4})
        EXPECT_LT(wrong_length(WalkKind::cells, 0.7, offset_mm, 60).mean, 16.0 * 0x1p-24 * (offset_mm + 10.0)) << offset_mm;
    EXPECT_GT(wrong_length(WalkKind::cells, 0.7, 1.0e6, 60).mean, 0.05);
}

TEST(Stability, OpalsFarFromTheirFilesOriginAreNoted) {
    const FarRender near = far_render(Place::moved_in_its_file, 1.0e3, 1), far = far_render(Place::moved_in_its_file, 1.0e5, 1);
    EXPECT_TRUE(near.notices.empty());
    EXPECT_TRUE(mentions(far.notices, "so far from the origin of its file that rounding moves the boundaries"));
}

/// Places count from where the camera looks: a scene may be a kilometre away.
TEST(Stability, ScenesFarFromTheOriginLoseNoLight) {
    for (const double offset_mm : {0.0, 1.0e4, 1.0e6}) {
        const FarRender far = far_render(Place::whole_scene_moved, offset_mm, 8);
        EXPECT_TRUE(far.notices.empty());
        EXPECT_LE(far.lost.mean, 1.0e-4) << offset_mm;
        EXPECT_NEAR(far.missing.mean, 0.0, 4.0 * far.missing.standard_error) << offset_mm;
    }
}

/// Whatever the angle, a walk is in the wrong cell no deeper than its tolerance: epsilon of sphere tracing, and rounding.
TEST(Stability, GrazingBoundaries) {
    for (const double angle_rad : {1.0, 1.0e-2, 1.0e-4, 1.0e-5}) {
        EXPECT_LT(grazing_error(WalkKind::sphere_tracing, angle_rad, 20).across_mm.mean, 1.0e-4) << angle_rad;
        EXPECT_LT(grazing_error(WalkKind::cells, angle_rad, 20).across_mm.mean, 1.0e-5) << angle_rad;
    }
    // Grazing rays take sphere tracing step after step; the times are a hundred thousand to one, a hundred suffices.
    EXPECT_GT(grazing_error(WalkKind::sphere_tracing, 1.0e-4, 20).us_per_ray,
              100.0 * grazing_error(WalkKind::cells, 1.0e-4, 2000).us_per_ray);
}

TEST(Stability, VoxelsMislabelInProportionToTheirSize) {
    const std::vector<VoxelError> errors = voxel_errors(1.0, {128, 512}, 150);
    const double ratio = errors[0].wrong.mean / errors[1].wrong.mean;
    EXPECT_GT(ratio, 3.0);
    EXPECT_LT(ratio, 5.0);
    // A note where grains are less than six voxels across and nothing better is in the file.
    for (const int grains : {40, 4000}) {
        SmallOpal small;
        small.grains = grains;
        small.voxel_mm = 0.2;
        OpalAsset asset = small.make();
        asset.sites.clear();
        std::vector<std::string> notices;
        const GrainSource source(asset, GrainsKind::automatic, "a.vdb", notices);
        EXPECT_EQ(mentions(notices, "a.vdb: grains are only"), grains == 4000) << grains;
    }
}

TEST(Stability, EwaldEnergyFollowsTheTolerance) {
    EXPECT_DOUBLE_EQ(ewald_band(0.02, 1000).energy_nm, 2.0 * ewald_band(0.01, 1000).energy_nm);
    EXPECT_LT(ewald_band(0.01, 1000).energy_nm, 1.0e-3 * two_beam_band().energy_nm);
    // Detunings are exact to 2^-24 or so: a tenth of a band of 1e-6.
    for (const double tolerance : {1.0e-1, 1.0e-3, 1.0e-5})
        EXPECT_NEAR(ewald_band(tolerance, 100000).single_over_double, 1.0, 0.02) << tolerance;
    EXPECT_NEAR(ewald_band(1.0e-6, 100000).single_over_double, 1.0, 0.2);
    const std::string scene = "[opal]\ndiffraction = \"ewald-fresnel\"\newald_tolerance = ";
    EXPECT_INPUT_ERROR(parse_scene(scene + "0.6\n", "a.toml", {}), "ewald_tolerance");
    EXPECT_INPUT_ERROR(parse_scene(scene + "0\n", "a.toml", {}), "ewald_tolerance");
    const ScratchFolder folder;
    write_opal_asset(SmallOpal().make(), folder / "opal.vdb");
    std::vector<std::string> notices;
    const HostScene host(
        parse_scene(scene + "0.02\n[[object]]\nkind = \"opal\"\nfile = '" + (folder / "opal.vdb").string() + "'\n", "a.toml", {}),
        notices);
    EXPECT_TRUE(mentions(notices, "is in proportion to opal.ewald_tolerance = 0.02"));
}

/// Three-beam theory has two closed forms: one family alone, and two alike, which couple as one that is sqrt 2 as strong.
TEST(Stability, ThreeBeamTheoryHasItsClosedForms) {
    for (const double coupling : {0.3, 1.0, 3.0})
        for (const double detuning : {0.0, 0.7, -2.0, 5.0}) {
            EXPECT_NEAR(three_beam_reflectance({{coupling, 0.0}, 0.0, {detuning, 0.0}}), two_beam_reflectance(coupling, detuning),
                        1.0e-5);
            EXPECT_NEAR(three_beam_reflectance({{coupling, coupling}, 0.4, {detuning, detuning}}),
                        two_beam_reflectance(std::sqrt(2.0) * coupling, detuning + 0.2), 1.0e-5);
        }
}

/// Where two families are met at once their odds add, which is a little less than they reflect together.
TEST(Stability, FamiliesTogetherNearZoneEdges) {
    for (const double block_um : {10.0, 25.0}) {
        const ZoneEdge at = zone_edge(0.0, block_um), away = zone_edge(units::rad_from_deg(5.0), block_um);
        EXPECT_EQ(at.strong_families, 2);
        EXPECT_EQ(away.strong_families, 1);
        EXPECT_LT(at.energy_error, -0.05);
        EXPECT_GT(at.energy_error, -0.3);  // sqrt 2 in the width of the band: 1 / sqrt 2 - 1
        EXPECT_NEAR(away.energy_error, 0.0, 0.01);
    }
}

TEST(Stability, TheLargestGrainVariesAtTheThreshold) {
    const std::vector<PercolationSpread> spread = percolation_spread(1000, {0.05, 0.1, 0.2}, 20);
    EXPECT_GT(spread[1].largest_deviation, 3.0 * spread[0].largest_deviation);
    EXPECT_GT(spread[1].largest_deviation, 3.0 * spread[2].largest_deviation);
    EXPECT_EQ(spread[0].warned, 0.0);
    EXPECT_EQ(spread[2].warned, 1.0);
    EXPECT_NEAR(spread[0].threshold, 0.1, 0.02);
}

TEST(Stability, PlatesOfAnyOpticalDepth) {
    for (const double depth : {1.0e-3, 1.0, 30.0, 1.0e4}) {
        const Estimate ratio = plate_transmission_ratio(depth, 2000);
        EXPECT_NEAR(ratio.mean, 1.0, 4.0 * ratio.standard_error + 1.0e-4) << depth;
        EXPECT_LT(ratio.standard_error, 0.02);
    }
}

void expect_all_light_accounted_for(const ScatteringBall& ball, const std::string& what) {
    EXPECT_NEAR(ball.missing.mean, ball.truncated.mean,
                4.0 * std::hypot(ball.missing.standard_error, ball.truncated.standard_error))
        << what;
    EXPECT_LT(ball.missing.standard_error, 0.02) << what;
}

TEST(Stability, ScatteringBallsOfAnyDepthKeepTheirLight) {
    for (const double depth : {1.0e-3, 1.0, 100.0, 1.0e4})
        expect_all_light_accounted_for(scattering_ball(depth, 64, 16), fmt::format("depth {}", depth));
}

TEST(Stability, TruncatedLightIsReportedAtAnyBounceLimit) {
    double before = 1.0;
    for (const int bounces : {8, 64, 512}) {
        const ScatteringBall ball = scattering_ball(30.0, bounces, 16);
        expect_all_light_accounted_for(ball, fmt::format("{} bounces", bounces));
        EXPECT_LT(ball.truncated.mean, before);
        before = ball.truncated.mean;
    }
}

/// A band of width w nm is met by one of the fixed wavelengths at w / 10 of its places, and then counts for 10 / w of itself: an
/// rms of sqrt(10 / w - 1).
TEST(Stability, NarrowBandsNeedContinuousWavelengths) {
    for (const double width_nm : {1.0, 5.0}) {
        const double expected = std::sqrt(10.0 / width_nm - 1.0);
        EXPECT_NEAR(band_error(WavelengthChoice::fixed_48, width_nm, 400, 0).energy_rms, expected, 0.2 * expected);
    }
    EXPECT_GT(band_error(WavelengthChoice::layers_48, 1.0, 100, 0).delta_e.mean, 2.0);
    const BandError drawn = band_error(WavelengthChoice::continuous, 1.0, 60, 100000);
    EXPECT_NEAR(drawn.energy_mean.mean, 0.0, 4.0 * drawn.energy_mean.standard_error);
    EXPECT_LT(drawn.energy_mean.standard_error, 0.02);
}

/// Logarithms 0, 1, 2 of the size and 0, 2, 3 of the cost: slope 1.5, residuals -1/6, 1/3, -1/6, last slope 1.
TEST(Scaling, ExponentsOfPowerLaws) {
    const double e = std::exp(1.0);
    const PowerLaw law = fit_power_law({{1.0, 1.0}, {e, e * e}, {e * e, e * e * e}});
    EXPECT_NEAR(law.exponent, 1.5, 1.0e-12);
    EXPECT_NEAR(law.standard_error, std::sqrt(1.0 / 12.0), 1.0e-12);
    EXPECT_NEAR(law.last_exponent, 1.0, 1.0e-12);
    const PowerLaw exact = fit_power_law({{10.0, 7.0}, {100.0, 700.0}});
    EXPECT_NEAR(exact.exponent, 2.0, 1.0e-12);
    EXPECT_EQ(exact.standard_error, 0.0);
}

TEST(Stability, WarningsSayWhatWentWrong) {
    PathCounters counters;
    EXPECT_TRUE(render_warnings(counters, 100000, 64).empty());
    counters.truncated_paths = 1000;
    counters.lost_paths = 100;
    counters.grain_crossings = 1000;
    counters.multi_beam_stays = 30;
    EXPECT_TRUE(render_warnings(counters, 100000, 64).empty());
    counters.truncated_paths = 2345;
    counters.lost_paths = 200;
    counters.multi_beam_stays = 35;
    counters.majorant_violations = 7;
    counters.not_a_number = 3;
    const std::vector<std::string> warnings = render_warnings(counters, 100000, 64);
    ASSERT_EQ(warnings.size(), 5u);
    EXPECT_EQ(warnings[0], "2.3 % of the paths were cut off after 64 bounces; raise render.max_bounces");
    EXPECT_NE(warnings[1].find("0.2 % of the paths left a body through gaps of its surface"), std::string::npos);
    EXPECT_NE(warnings[2].find("3.5 % of the stays in grains begin near two strong reflections"), std::string::npos);
    EXPECT_NE(warnings[3].find("7 collisions met a field above its majorant"), std::string::npos);
    EXPECT_NE(warnings[4].find("3 samples were not numbers"), std::string::npos);
}

}  // namespace
}  // namespace opal
