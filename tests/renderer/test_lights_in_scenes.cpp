// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "../formats/expect_error.h"
#include "formats/units.h"
#include "on_backends.h"
#include "small_opal.h"

namespace opal {
namespace {

/// Those that end with Loop are short enough to run in the devices' loop, too.
class LightsInScenes : public OnBackends {};
class LightsInScenesLoop : public OnBackends {};

/// A large grey plane under some lights, seen by an orthographic camera that shows a square of 0.2 mm around the origin.
std::string lit_plane(const std::string& lights, const std::string& render = "", double environment = 0.0) {
    return "[render]\nwidth = 16\nheight = 16\nfilter = \"box\"\nsampler = \"independent\"\n" + render +
           "[environment]\nkind = \"constant\"\nradiance = " + std::to_string(environment) +
           "\n[camera]\nkind = \"orthographic\"\nview_height_mm = 0.2\nposition_mm = [0, -30, 10]\ntarget_mm = [0, 0, 0]\n"
           "[color]\nupsampling = \"basis\"\n[[material]]\nname = \"grey\"\nalbedo = 0.5\n[[object]]\nkind = \"plane\"\n"
           "material = \"grey\"\n" +
           lights;
}

struct LitCase {
    std::string name, light;
    double irradiance;  ///< at the origin, of white light of radiance or irradiance as in `light`
};

std::vector<LitCase> lit_cases() {
    const double d2 = 25.0 + 400.0;
    return {
        {"sphere", "[[light]]\nkind = \"sphere\"\nposition_mm = [5, 0, 20]\nradius_mm = 2\nradiance = 40\n",
         40.0 * units::pi * 4.0 / d2 * 20.0 / std::sqrt(d2)},
        {"disk", "[[light]]\nkind = \"area\"\nposition_mm = [0, 0, 20]\nradius_mm = 6\nradiance = 4\n",
         4.0 * units::pi * 36.0 / (36.0 + 400.0)},
        {"rectangle", "[[light]]\nkind = \"area\"\nposition_mm = [0, 0, 20]\nwidth_mm = 30\nheight_mm = 12\nradiance = 3\n",
         // Four corners of 15 mm by 6 mm, in the orientation that is symmetric in them.
         [] {
             const double a = 15.0 / 20.0, b = 6.0 / 20.0, ra = std::sqrt(1.0 + a * a), rb = std::sqrt(1.0 + b * b);
             return 4.0 * 3.0 * 0.5 * (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb));
         }()},
        {"spot", "[[light]]\nkind = \"spot\"\nposition_mm = [0, 0, 20]\nradius_mm = 0.5\nradiance = 5000\n",
         5000.0 * units::pi * 0.25 / (0.25 + 400.0)},
        {"sun", "[[light]]\nkind = \"sun\"\nelevation_deg = 40\nazimuth_deg = 120\nirradiance = 3\n",
         3.0 * std::sin(units::rad_from_deg(40.0))},
    };
}

MeanEstimate green(const Rendered& rendered) {
    return region_mean(rendered.image, "G", 0, 0, 16, 16);
}

/// A plane of albedo 1/2 shows half the irradiance over pi. The view is 0.2 mm wide: over it the irradiance varies by less than
/// (0.1 mm / 20 mm)^2.
TEST_P(LightsInScenesLoop, DiffusePlaneHasTheClosedFormsOfItsIrradiance) {
    for (const LitCase& lit : lit_cases()) {
        const double expected = 0.5 * lit.irradiance / units::pi;
        const MeanEstimate mean = green(render_text(lit_plane(lit.light), 256, GetParam()));
        EXPECT_NEAR(mean.mean, expected, 4.0 * mean.standard_error + 2.5e-5 * expected) << lit.name;
        EXPECT_LT(mean.standard_error, 0.01 * expected) << lit.name;
    }
}

/// Drawn lights alone, drawn directions alone, and both: the same mean, and both together are never much noisier than the better
/// of the two. (By directions alone small lights are hardly ever met: large ones here.)
TEST_P(LightsInScenes, BothWaysOfFindingLightAgree) {
    const std::string lights =
        "[[light]]\nkind = \"sphere\"\nposition_mm = [3, 0, 6]\nradius_mm = 4\nradiance = 3\ncolor = [1, 0.6, 0.3]\n"
        "[[light]]\nkind = \"area\"\nposition_mm = [-4, 0, 4]\nwidth_mm = 9\nheight_mm = 9\nradiance = 2\nilluminant = \"A\"\n"
        "[[light]]\nkind = \"sun\"\nelevation_deg = 35\nangular_diameter_deg = 40\nazimuth_deg = 100\n";
    std::vector<MeanEstimate> estimates;
    int seed = 1;
    for (const char* sampling : {"connections", "scattering", "both"})
        estimates.push_back(green(render_text(
            lit_plane(lights, "seed = " + std::to_string(seed++) + "\nlight_sampling = \"" + std::string(sampling) + "\"\n", 0.4),
            512, GetParam())));
    for (const MeanEstimate& estimate : estimates) EXPECT_LT(estimate.standard_error, 0.01 * estimates[2].mean);
    for (std::size_t i = 0; i < 2; ++i)
        EXPECT_NEAR(estimates[i].mean, estimates[2].mean,
                    4.0 * std::hypot(estimates[i].standard_error, estimates[2].standard_error));
    // Variances: at most 1.2 times the better one's (the estimates of the variances themselves are good to some percent).
    const double better = std::min(estimates[0].standard_error, estimates[1].standard_error);
    EXPECT_LT(std::pow(estimates[2].standard_error / better, 2.0), 1.2);
}

/// The camera sees a light as bright as it is, in its colour; one that it is not to see it looks through; the back is black.
TEST_P(LightsInScenes, CameraSeesLights) {
    const auto look = [&](const std::string& light) {
        return render_text(
            "[render]\nwidth = 8\nheight = 8\nsampler = \"independent\"\n[environment]\nkind = \"constant\"\n"
            "radiance = 0.25\n[camera]\nposition_mm = [0, -40, 0]\ntarget_mm = [0, 0, 0]\nvertical_fov_deg = 1\n"
            "[[material]]\nname = \"grey\"\n[[object]]\nkind = \"sphere\"\nmaterial = \"grey\"\n"
            "translate_mm = [0, -90, 0]\n" +
                light,
            256, GetParam());
    };
    const auto expect = [](const Rendered& rendered, double value) {
        const MeanEstimate mean = region_mean(rendered.image, "G", 0, 0, 8, 8);
        EXPECT_NEAR(mean.mean, value, 4.0 * mean.standard_error);
        EXPECT_LE(mean.standard_error, 0.02 * value);
    };
    const std::string sphere = "[[light]]\nkind = \"sphere\"\nposition_mm = [0, 0, 0]\nradius_mm = 5\nradiance = 7\n";
    expect(look(sphere), 7.0);
    expect(look(sphere + "visible = false\n"), 0.25);
    const std::string disk = "[[light]]\nkind = \"area\"\nposition_mm = [0, 0, 0]\nradius_mm = 5\nradiance = 7\ntarget_mm = ";
    expect(look(disk + "[0, -9, 0]\n"), 7.0);
    expect(look(disk + "[0, 9, 0]\n"), 0.0);
    // The sun behind the object is seen in the sky: 0.25 and irradiance / (pi sin^2).
    const double sine = std::sin(units::rad_from_deg(5.0));
    const std::string sun =
        "[[light]]\nkind = \"sun\"\nelevation_deg = 0\nazimuth_deg = 90\nangular_diameter_deg = 10\nirradiance = 0.1\n";
    expect(look(sun), 0.25 + 0.1 / (units::pi * sine * sine));
    expect(look(sun + "visible = false\n"), 0.25);
}

/// Inside one large luminous sphere, in the dark, a clear scattering opal is as bright as the sphere: nothing is lost or counted
/// twice, whichever way light is found.
TEST_P(LightsInScenes, FurnaceOfASphereLight) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 300.0;
    small.constants.sigma_s_mie_per_mm = 0.2;
    const ScratchFolder folder;
    write_opal_asset(small.make(), folder / "opal.vdb");
    // Six square lights that face inwards form a closed room.
    std::string room;
    for (const char* place : {"[50, 0, 0]", "[-50, 0, 0]", "[0, 50, 0]", "[0, -50, 0]", "[0, 0, 50]", "[0, 0, -50]"})
        room +=
            "[[light]]\nkind = \"area\"\nwidth_mm = 100\nheight_mm = 100\nradiance = 1\ntarget_mm = [0, 0, 0]\nposition_mm = " +
            std::string(place) + "\n";
    const Rendered rendered = render_text(
        "[render]\nwidth = 32\nheight = 32\nsampler = \"independent\"\nfilter = \"box\"\n[environment]\nkind = \"constant\"\n"
        "radiance = 0\n[camera]\nposition_mm = [0, -20, 5]\ntarget_mm = [0, 0, 0]\nvertical_fov_deg = 18\n"
        "[[material]]\nname = \"white\"\nalbedo = 1.0\n[[object]]\nkind = \"sphere\"\nradius_mm = 1\nmaterial = \"white\"\n"
        "translate_mm = [0, 0, -4.2]\n[[object]]\nkind = \"opal\"\nfile = '" +
            (folder / "opal.vdb").string() + "'\n" + room,
        256, GetParam());
    const MeanEstimate mean = region_mean(rendered.image, "G", 0, 0, 32, 32);
    const double truncated = rendered.outcome.totals.truncated_rgb[1] / double(rendered.outcome.totals.samples);
    EXPECT_NEAR(mean.mean + truncated, 1.0, 4.0 * mean.standard_error);
    EXPECT_LT(mean.standard_error, 0.004);
}

TEST(LightsInsideBodies, AreRefused) {
    SmallOpal small;
    const ScratchFolder folder;
    write_opal_asset(small.make(), folder / "opal.vdb");
    EXPECT_INPUT_ERROR(render_text("[[object]]\nkind = \"opal\"\nfile = '" + (folder / "opal.vdb").string() +
                                       "'\n[[light]]\nkind = \"sphere\"\nposition_mm = [0, 1, 0]\nradius_mm = 0.1\n",
                                   1),
                       "light.0: stands at [0, 1, 0] inside a transparent object");
    EXPECT_INPUT_ERROR(render_text("[[object]]\nkind = \"opal\"\nfile = '" + (folder / "opal.vdb").string() +
                                       "'\n[[light]]\nkind = \"area\"\nposition_mm = [0, 0, 5]\ntarget_mm = [0, 9, 5]\n"
                                       "width_mm = 1\nheight_mm = 5\n",
                                   1),
                       "light.0: the light at [0, 0, 5] reaches into a transparent object");
}

INSTANTIATE_TEST_SUITE_P(, LightsInScenes, cpu_and_cuda(), backend_name);
INSTANTIATE_TEST_SUITE_P(, LightsInScenesLoop, cpu_loop_and_cuda(), backend_name);

}  // namespace
}  // namespace opal
