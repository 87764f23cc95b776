// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "chi_square.h"
#include "formats/units.h"
#include "renderer/cpu/light_guides.h"
#include "small_opal.h"

namespace opal {
namespace {

SmallOpal scattering_opal() {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 300.0;
    small.constants.sigma_s_rayleigh_400nm_per_mm = 0.15;
    small.constants.sigma_s_mie_per_mm = 0.2;
    small.constants.mie_phase = MiePhase::lorenz_mie;
    small.constants.sigma_a_per_mm = absorber_spectrum("carbon", 0.1);
    return small;
}

std::string scene_of(const std::filesystem::path& opal, const std::string& render, const std::string& lights = "") {
    return "[render]\nwidth = 32\nheight = 32\nsampler = \"independent\"\n" + render +
           "[camera]\nposition_mm = [0, -20, 8]\ntarget_mm = [0, 0, 0]\nvertical_fov_deg = 18\n[[object]]\nkind = \"opal\"\n"
           "file = '" +
           opal.string() + "'\n" + lights;
}

/// Half of the directions come from photons that know the lights, and the picture stays the same: the spectrum of the whole
/// picture, bin by bin, in the studio and under one small lamp, with wavelengths whose phase functions and coefficients differ.
TEST(GuidedScattering, ChangesNothingButTheNoise) {
    const ScratchFolder folder;
    write_opal_asset(scattering_opal().make(), folder / "opal.vdb");
    const std::string lamp =
        "[environment]\nkind = \"constant\"\nradiance = 0.1\n[[light]]\nkind = \"sphere\"\n"
        "position_mm = [-12, -6, 14]\nradius_mm = 3\nradiance = 10\ncolor = [1, 0.8, 0.5]\n";
    for (const std::string& lights : {std::string(), lamp}) {
        const auto render = [&](const char* guided) {
            return render_text(
                       scene_of(folder / "opal.vdb",
                                std::string("guided = ") + guided + "\nseed = " + (guided[0] == 't' ? "1" : "2") + "\n", lights),
                       96)
                .outcome.totals;
        };
        const SpectrumTotals guided = render("true"), plain = render("false");
        double statistic = 0.0;
        int used = 0;
        for (std::size_t bin = 2; bin + 6 < num_bins; ++bin, ++used) {
            const auto mean = [&](const SpectrumTotals& totals) { return totals.radiance[bin] / double(totals.samples); };
            const auto variance = [&](const SpectrumTotals& totals) {
                return (totals.radiance_squared[bin] / double(totals.samples) - mean(totals) * mean(totals)) /
                       double(totals.samples);
            };
            const double difference = mean(guided) - mean(plain);
            statistic += difference * difference / (variance(guided) + variance(plain));
        }
        EXPECT_LT(statistic, chi_square_limit(used));
        EXPECT_GT(statistic, 0.25 * used) << "errors are overestimated: the test would see nothing";
    }
}

/// The guide is the same, bit for bit, however threads share the photons.
TEST(GuidedScattering, GuidesAreReproducible) {
    const ScratchFolder folder;
    write_opal_asset(scattering_opal().make(), folder / "opal.vdb");
    const SceneDescription scene = parse_scene(scene_of(folder / "opal.vdb", "guided = true\n"), "test.toml", {});
    std::vector<std::string> notices;
    const HostScene host(scene, notices);
    const EmbreeScene intersector(host.meshes());
    const LightGuides first(host, intersector), second(host, intersector);
    const LightGuideView &a = first.scene().bodies[0].guide, &b = second.scene().bodies[0].guide;
    ASSERT_NE(a.weight, nullptr);
    const std::size_t values = std::size_t(a.cells[0]) * a.cells[1] * a.cells[2] * guide_bins;
    EXPECT_TRUE(std::equal(a.weight, a.weight + values, b.weight));
}

/// Directions are drawn in proportion to the guide's share of the light times the phase function, as their density says.
TEST(GuidedScattering, DirectionsFollowTheGuide) {
    std::vector<float> weight;
    for (int bin = 0; bin < guide_bins; ++bin) weight.push_back(float(bin * 7919 % 101) * (bin % 5 == 0 ? 3.0f : 0.0f));
    LightGuideView guide;
    guide.weight = weight.data();
    guide.cells_per_mm = {1, 1, 1};
    for (int& cells : guide.cells) cells = 1;
    for (int node = 0; node < guide_phase_nodes; ++node) guide.phase[node] = 0.02f + 0.01f * float(node);
    const GuidedDirections directions(guide, {}, normalize({0.3f, -0.5f, 0.8f}));
    ASSERT_TRUE(directions.known());
    EXPECT_TRUE(check_sampler(
        "guide", SamplerDomain<2>{{-1.0, -units::pi}, {1.0, units::pi}, {16, 32}},
        [&](SamplerRandom& random) {
            const float u1 = random.next();
            const Vec3 d = directions.sample(u1, random.next());
            return SamplerPoint<2>{double(d.z), std::atan2(double(d.y), double(d.x))};
        },
        [&](SamplerPoint<2> p) {
            const double sine = std::sqrt(1.0 - p[0] * p[0]);
            return double(directions.pdf({float(sine * std::cos(p[1])), float(sine * std::sin(p[1])), float(p[0])}));
        }));
}

}  // namespace
}  // namespace opal
