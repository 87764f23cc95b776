// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "../formats/expect_error.h"
#include "formats/metals.h"
#include "on_backends.h"
#include "round_body.h"
#include "small_opal.h"

/// Balls of every material under uniform light of radiance 1, against closed forms.
namespace opal {
namespace {

/// Those that end with Loop are short enough to run in the devices' loop, too.
class Materials : public OnBackends {};
class MaterialsLoop : public OnBackends {};

const std::string view =
    "[render]\nwidth = 32\nheight = 32\nsampler = \"independent\"\nfilter = \"box\"\n[camera]\nposition_mm = [0, -20, 5]\n"
    "target_mm = [0, 0, 0]\nvertical_fov_deg = 14\n[environment]\nkind = \"constant\"\n";

std::string ball(const std::string& material) {
    return "[[material]]\nname = \"m\"\n" + material + "[[object]]\nkind = \"sphere\"\nradius_mm = 3\nmaterial = \"m\"\n";
}

void expect_invisible(const char* backend, const std::string& objects, int samples, double largest_error) {
    const Rendered rendered = render_text(view + objects, samples, backend);
    for (const char* channel : {"R", "G", "B"}) {
        const MeanEstimate estimate = region_mean(rendered.image, channel, 0, 0, 32, 32);
        const double truncated = rendered.outcome.totals.truncated_rgb[1] / double(rendered.outcome.totals.samples);
        EXPECT_NEAR(estimate.mean + truncated, 1.0, 4.0 * estimate.standard_error + 1.0e-4) << channel << objects;
        EXPECT_LT(estimate.standard_error, largest_error) << "too noisy to say anything";
    }
    EXPECT_EQ(rendered.outcome.counters.not_a_number, 0u);
}

TEST_P(Materials, GlassIsInvisible) {
    for (const char* glass : {"n = 1.5\n", "n = \"silica\"\n", "n = 1.5\nroughness = 0.3\n", "n = \"silica\"\nroughness = 0.1\n"})
        expect_invisible(GetParam(), ball(std::string("kind = \"dielectric\"\n") + glass), 200, 0.006);
}

TEST_P(Materials, ScatteringGlassIsInvisible) {
    expect_invisible(GetParam(),
                     ball("kind = \"dielectric\"\nroughness = 0.2\nmedium = { sigma_s_per_mm = 0.4, asymmetry = 0.6 }\n"), 80,
                     0.006);
}

/// A rough opal with a polished ball of glass inside: two interfaces with media between.
TEST_P(Materials, RoughOpalIsInvisible) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 300.0;
    const ScratchFolder folder;
    write_opal_asset(small.make(), folder / "opal.vdb");
    expect_invisible(
        GetParam(),
        "[[object]]\nkind = \"opal\"\nroughness = 0.2\nfile = '" + (folder / "opal.vdb").string() +
            "'\n[[material]]\nname = \"g\"\nkind = \"dielectric\"\nn = 1.6\n[[object]]\nkind = \"sphere\"\nradius_mm = 1\n"
            "material = \"g\"\npriority = 1\n",
        150, 0.006);
}

/// A rough white ball inside glass, of a higher index than the glass and of a lower one, lit through the glass.
TEST_P(Materials, WhitePlasticInsideGlassIsInvisible) {
    for (const char* coat : {"n = 1.6\n", "n = 1.4\n"})
        expect_invisible(GetParam(),
                         ball("kind = \"dielectric\"\nn = 1.5\n") +
                             "[[material]]\nname = \"p\"\nkind = \"plastic\"\nalbedo = 1.0\nroughness = 0.3\n" + coat +
                             "[[object]]\nkind = \"sphere\"\nradius_mm = 1.8\nmaterial = \"p\"\n",
                         150, 0.0012);
}

/// An exact surface far from where the scene's coordinates begin is the same: no path is lost.
TEST_P(Materials, ExactSurfacesLoseNoPathsWhereverTheyAre) {
    OpalAsset asset = SmallOpal().make();
    asset.bezier_patches = round_body(2.6, 1.8, 1.2);
    asset.constants.sigma_s_mie_per_mm = 0.3;
    const ScratchFolder folder;
    write_opal_asset(asset, folder / "opal.vdb");
    for (const int place_mm : {0, 1000, 10000}) {
        const std::string x = std::to_string(place_mm);
        const Rendered rendered = render_text(
            "[render]\nwidth = 32\nheight = 32\nsampler = \"independent\"\nfilter = \"box\"\n[opal]\ndiffraction = \"none\"\n"
            "[camera]\nposition_mm = [" +
                x + ", -20, 5]\ntarget_mm = [" + x +
                ", 0, 0]\nvertical_fov_deg = 14\n"
                "[environment]\nkind = \"constant\"\n[[object]]\nkind = \"opal\"\nexact = true\ntranslate_mm = [" +
                x + ", 0, 0]\nfile = '" + (folder / "opal.vdb").string() + "'\n",
            100, GetParam());
        EXPECT_EQ(rendered.outcome.counters.lost_paths, 0u) << place_mm;
        const MeanEstimate estimate = region_mean(rendered.image, "G", 0, 0, 32, 32);
        const double truncated = rendered.outcome.totals.truncated_rgb[1] / double(rendered.outcome.totals.samples);
        EXPECT_NEAR(estimate.mean + truncated, 1.0, 4.0 * estimate.standard_error + 1.0e-4) << place_mm;
    }
}

/// Two overlapping parts of an exact surface are one body: nothing between them.
TEST_P(MaterialsLoop, PartsOfAnExactSurfaceAreOneBody) {
    OpalAsset asset = SmallOpal().make();
    asset.bezier_patches = round_body(1.6, 1.4, 1.2, -0.8, 0);
    const std::vector<BezierPatch> second = round_body(1.5, 1.5, 1.5, 0.9, 1);
    asset.bezier_patches.insert(asset.bezier_patches.end(), second.begin(), second.end());
    const ScratchFolder folder;
    write_opal_asset(asset, folder / "opal.vdb");
    expect_invisible(GetParam(),
                     "[opal]\ndiffraction = \"none\"\n[[object]]\nkind = \"opal\"\nexact = true\nfile = '" +
                         (folder / "opal.vdb").string() + "'\n",
                     120, 0.006);
}

TEST_P(MaterialsLoop, WhitePlasticIsInvisible) {
    for (const char* roughness : {"0.0", "0.3"})
        expect_invisible(GetParam(), ball(std::string("kind = \"plastic\"\nalbedo = 1.0\nroughness = ") + roughness + "\n"), 100,
                         0.006);
}

/// The middle of a golden ball, where light falls within 8 degrees of the normal: reflectance is that at the normal to 1e-4.
TEST_P(Materials, GoldReflectsAsGold) {
    const Rendered rendered = render_text(view + ball("kind = \"conductor\"\nmetal = \"gold\"\n"), 2000, GetParam());
    const MetalIndex gold = MetalIndex::of_metal("gold");
    SampledSpectrum reflectance;
    for (int i = 0; i < colorimetric_samples; ++i) {
        reflectance.wavelength_nm.push_back(colorimetric_min_nm + i);
        reflectance.value.push_back(normal_reflectance(gold.at(colorimetric_min_nm + i)));
    }
    const Rgb3d expected = linear_srgb_from_xyz(xyz_of(reflectance, illuminant_spectrum(IlluminantKind::d65)));
    const double value[3] = {expected.r, expected.g, expected.b};
    const char* channels[3] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
        const MeanEstimate estimate = region_mean(rendered.image, channels[c], 15, 15, 17, 17);
        EXPECT_NEAR(estimate.mean, value[c], 4.0 * estimate.standard_error + 5.0e-4) << channels[c];
        EXPECT_LT(estimate.standard_error, 0.02);
    }
}

/// A density of 1 everywhere is the homogeneous medium.
TEST_P(Materials, ADensityGridOfOneIsTheMediumItself) {
    const ScratchFolder folder;
    const openvdb::FloatGrid::Ptr density = box_field({openvdb::Vec3d(-4.0), openvdb::Vec3d(4.0)}, 0.5,
                                                      [](const openvdb::Vec3d& p) { return p.x() > 100.0 ? 0.0 : 0.5; });
    density->setName("density");
    openvdb::io::File((folder / "d.vdb").string()).write({density});
    const std::string medium = "kind = \"dielectric\"\nmedium = { sigma_s_per_mm = 0.3, sigma_a_per_mm = 0.1, asymmetry = 0.5";
    const Rendered same = render_text(view + ball(medium + " }\n"), 120, GetParam());
    const Rendered grid = render_text(
        view + ball(medium + ", density_scale = 2, density_file = '" + (folder / "d.vdb").string() + "' }\n"), 120, GetParam());
    const MeanEstimate a = region_mean(same.image, "G", 8, 8, 24, 24), b = region_mean(grid.image, "G", 8, 8, 24, 24);
    EXPECT_LT(a.mean, 0.9);
    EXPECT_NEAR(a.mean, b.mean, 4.0 * std::hypot(a.standard_error, b.standard_error));
    EXPECT_LT(a.standard_error, 0.005);
    const auto with = [&](const std::string& keys) {
        return view + ball(medium + ", " + keys + ", density_file = '" + (folder / "d.vdb").string() + "' }\n");
    };
    EXPECT_INPUT_ERROR(render_text(with("density_grid = \"densty\""), 1), "d.vdb: no grid of floats named 'densty'");
    density->tree().setValueOn({0, 0, 0}, -1.0f);
    openvdb::io::File((folder / "d.vdb").string()).write({density});
    EXPECT_INPUT_ERROR(render_text(with("density_scale = 1"), 1),
                       "grid density: voxel [0, 0, 0] holds -1; allowed: numbers from 0");
    density->setTransform(openvdb::math::Transform::createLinearTransform(1.0e-4));
    openvdb::io::File((folder / "d.vdb").string()).write({density});
    EXPECT_INPUT_ERROR(render_text(with("density_scale = 1"), 1), "voxels along the object's longest side");
}

INSTANTIATE_TEST_SUITE_P(, Materials, cpu_and_cuda(), backend_name);
INSTANTIATE_TEST_SUITE_P(, MaterialsLoop, cpu_loop_and_cuda(), backend_name);

}  // namespace
}  // namespace opal
