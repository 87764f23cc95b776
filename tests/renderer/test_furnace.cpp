// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "on_backends.h"
#include "renderer/host/spectrum_tables.h"
#include "small_opal.h"

namespace opal {
namespace {

/// Those that end with Loop are short enough to run in the devices' loop, too.
class Furnace : public OnBackends {};
class FurnaceLoop : public OnBackends {};

/// An opal without absorption under uniform light of radiance 1 must be invisible: every sample's expected value is 1 at every
/// wavelength, whatever reflects, refracts, diffracts or scatters, up to what the bounce limit cuts off, which the render
/// reports.
void expect_invisible(const char* backend, const SmallOpal& small, const std::string& settings, int samples,
                      double largest_error = 0.003,
                      const std::string& view = "position_mm = [0, -20, 5]\ntarget_mm = [0, 0, 0]\n",
                      const std::string& render = "") {
    const ScratchFolder folder;
    write_opal_asset(small.make(), folder / "opal.vdb");
    const Rendered rendered = render_text(
        "[render]\nwidth = 48\nheight = 48\nsampler = \"independent\"\nfilter = \"box\"\n" + render + "[camera]\n" + view +
            "vertical_fov_deg = 14\n[environment]\nkind = \"constant\"\n[[object]]\nkind = \"opal\"\nfile = '" +
            (folder / "opal.vdb").string() + "'\n" + settings,
        samples, backend);
    const RenderOutcome& outcome = rendered.outcome;
    EXPECT_EQ(outcome.counters.not_a_number, 0u);
    EXPECT_LE(outcome.counters.lost_paths, outcome.totals.samples / 100000);

    const double n = double(outcome.totals.samples);
    const char* channels[3] = {"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) {
        const char* channel = channels[c];
        const MeanEstimate estimate = region_mean(rendered.image, channel, 0, 0, 48, 48);
        EXPECT_NEAR(estimate.mean + outcome.totals.truncated_rgb[c] / n, 1.0, 4.0 * estimate.standard_error) << channel;
        EXPECT_LT(estimate.standard_error, largest_error) << "too noisy to say anything";
    }
    const SpectrumTablesData tables = make_spectrum_tables();
    for (int bin = 0; bin < num_bins; ++bin) {
        double white = 0.0;
        int count = 0;
        for (double w = std::max(360.0, bin_centre_nm(bin) - 5.0); w <= std::min(830.0, bin_centre_nm(bin) + 5.0);
             w += 0.1, ++count)
            white += double(table_at(tables.view().white, float(w)));
        white /= count;
        const double mean = outcome.totals.radiance[std::size_t(bin)] / n;
        const double truncated = outcome.totals.truncated[std::size_t(bin)] / n;
        const double truncated_error = std::sqrt(outcome.totals.truncated_squared[std::size_t(bin)] / n / n);
        const double error = std::sqrt((outcome.totals.radiance_squared[std::size_t(bin)] / n - mean * mean) / n);
        EXPECT_NEAR(mean / white + truncated, 1.0, 4.0 * (error / white + truncated_error)) << bin_centre_nm(bin) << " nm";
    }
}

TEST_P(Furnace, ClearGem) {
    SmallOpal small;
    expect_invisible(GetParam(), small, "[opal]\ndiffraction = \"none\"\n", 640);
}

TEST_P(Furnace, Diffraction) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 300.0;
    expect_invisible(GetParam(), small, "", 256);
}

TEST_P(Furnace, DiffractionInVoxels) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 300.0;
    expect_invisible(GetParam(), small, "[opal]\ngrains = \"voxels\"\n", 256);
}

TEST_P(Furnace, StrongDiffractionInAir) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 320.0;
    small.constants.n_medium = 1.0;
    expect_invisible(GetParam(), small, "", 128, 0.005);
}

TEST_P(Furnace, DiffractionAndScattering) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 280.0;
    small.constants.sigma_s_rayleigh_400nm_per_mm = 0.3;
    small.constants.sigma_s_mie_per_mm = 0.4;
    expect_invisible(GetParam(), small, "", 128, 0.005);
    expect_invisible(GetParam(), small, "[opal]\ncompanions = 0\n", 256, 0.005);
}

/// Scattering is what comes next where hardly anything diffracts: there no ray is cast as far as the surface.
TEST_P(Furnace, ScatteringInVoxels) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 280.0;
    small.constants.sigma_s_mie_per_mm = 0.8;
    expect_invisible(GetParam(), small, "[opal]\ngrains = \"voxels\"\ndiffraction = \"ewald-fresnel\"\n", 64, 0.005);
}

TEST_P(Furnace, FieldsThatVary) {
    SmallOpal small;
    small.radius_mm = 1.5;
    small.grains = 12;
    small.constants.sphere_diameter_nm = 280.0;
    small.fields[0] = [](const auto& p) { return 1.0 + p.x() / 4.0; };  // of no absorption at all
    small.fields[1] = [](const auto& p) { return 0.5 + 0.5 * std::sin(6.0 * p.z()); };
    small.fields[2] = [](const auto& p) { return p.y() > 0.3 ? 1.6 : 0.1; };
    const std::string view = "position_mm = [0, -10, 2.5]\ntarget_mm = [0, 0, 0]\n";
    expect_invisible(GetParam(), small, "[opal]\ncompanions = 0\n", 128, 0.008, view);
    expect_invisible(GetParam(), small, "[opal]\ncompanions = 3\n", 64, 0.008, view);
    expect_invisible(GetParam(), small, "[opal]\ncompanions = 7\nmajorants = \"global\"\n", 48, 0.008, view);
}

/// Everything at once: named materials that disperse, faults, mosaic spread, tabulated phase functions, and every number of
/// lanes.
TEST_P(Furnace, EveryFeature) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 280.0;
    small.constants.n_sphere = RefractiveIndex::of_material("silica");
    small.constants.n_medium = RefractiveIndex::of_material("water");
    small.constants.stacking_fault_probability = 0.15;
    small.constants.mosaic_spread_deg = 1.5;
    small.constants.sigma_s_rayleigh_400nm_per_mm = 0.2;
    small.constants.sigma_s_mie_per_mm = 0.2;
    small.constants.mie_phase = MiePhase::lorenz_mie;
    // Where refraction disperses, companions drop out at the surface: as noisy as one wavelength.
    expect_invisible(GetParam(), small, "[opal]\ncompanions = 3\n", 120, 0.005);
    expect_invisible(GetParam(), small, "[opal]\ncompanions = 7\ndispersion = \"bands\"\n", 110, 0.005);
}

/// In a dense body guiding must not move the light into samples too rare to be met: five optical depths per mm, bodies of mm.
TEST_P(Furnace, GuidedScatteringInADenseBody) {
    SmallOpal small;
    small.constants.sigma_s_mie_per_mm = 5.0;
    expect_invisible(GetParam(), small, "[opal]\ndiffraction = \"none\"\n", 48, 0.004,
                     "position_mm = [0, -20, 5]\ntarget_mm = [0, 0, 0]\n", "guided = true\nmax_bounces = 4096\n");
}

/// Half of the scattered light drawn towards where photons came from.
TEST_P(Furnace, GuidedScattering) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 300.0;
    small.constants.sigma_s_rayleigh_400nm_per_mm = 0.1;
    small.constants.sigma_s_mie_per_mm = 0.2;
    small.constants.mie_phase = MiePhase::lorenz_mie;
    expect_invisible(GetParam(), small, "", 180, 0.005, "position_mm = [0, -20, 5]\ntarget_mm = [0, 0, 0]\n", "guided = true\n");
}

TEST_P(Furnace, OtherModels) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 300.0;
    for (const char* model : {"laue", "ewald-fresnel"})
        expect_invisible(GetParam(), small, "[opal]\ndiffraction = \"" + std::string(model) + "\"\newald_tolerance = 0.02\n", 100,
                         0.005);
}

/// From inside there is nothing to see either.
TEST_P(Furnace, CameraInsideTheOpal) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 300.0;
    expect_invisible(GetParam(), small, "[[material]]\nname = \"unused\"\n", 192, 0.004,
                     "position_mm = [0, -1, 0.5]\ntarget_mm = [0, 1, 0]\n");
}

/// Few bounces: what is cut off is large, and must be reported to the same accuracy.
TEST_P(FurnaceLoop, TruncationIsReported) {
    SmallOpal small;
    small.constants.sigma_s_mie_per_mm = 1.0;
    const ScratchFolder folder;
    write_opal_asset(small.make(), folder / "opal.vdb");
    const Rendered rendered = render_text(
        "[render]\nwidth = 48\nheight = 48\nmax_bounces = 4\nsampler = \"independent\"\n[camera]\nposition_mm = [0, -20, 5]\n"
        "target_mm = [0, 0, 0]\nvertical_fov_deg = 14\n[environment]\nkind = \"constant\"\n[[object]]\nkind = \"opal\"\nfile = "
        "'" +
            (folder / "opal.vdb").string() + "'\n",
        64, GetParam());
    const MeanEstimate green = region_mean(rendered.image, "G", 0, 0, 48, 48);
    const double truncated = rendered.outcome.totals.truncated_rgb[1] / double(rendered.outcome.totals.samples);
    EXPECT_GT(truncated, 0.05);
    EXPECT_GT(rendered.outcome.counters.truncated_paths, 0u);
    // Both halves of the sum are noisy here: the truncated share is a yes-or-no per path.
    const double truncated_error = std::sqrt(truncated * (1.0 - truncated) / double(rendered.outcome.totals.samples));
    EXPECT_NEAR(green.mean + truncated, 1.0, 4.0 * (green.standard_error + truncated_error));
}

/// A perfectly white diffuse floor under the opal: light that passes through the gem and comes back is still all there.
TEST_P(Furnace, WithAWhiteFloor) {
    SmallOpal small;
    expect_invisible(GetParam(), small,
                     "[[material]]\nname = \"white\"\nalbedo = 1.0\n[[object]]\nkind = \"plane\"\nmaterial = "
                     "\"white\"\ntranslate_mm = [0, 0, -3.1]\n",
                     256);
}

INSTANTIATE_TEST_SUITE_P(, Furnace, cpu_and_cuda(), backend_name);
INSTANTIATE_TEST_SUITE_P(, FurnaceLoop, cpu_loop_and_cuda(), backend_name);

}  // namespace
}  // namespace opal
