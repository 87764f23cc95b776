// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <span>

#include "formats/illuminant.h"
#include "formats/metals.h"
#include "renderer/core/crystal.h"
#include "small_opal.h"

namespace opal {
namespace {

/// Quaternion that turns the lattice's [111] onto +Z.
openvdb::math::Quat<float> stacking_axis_up() {
    return {openvdb::Vec3f(1.0f, -1.0f, 0.0f).unit(), float(std::acos(std::sqrt(1.0 / 3.0)))};
}

/// A plate of one grain, its (111) planes along its faces, seen from above or below.
Image plate_hkl(double sphere_diameter_nm, double camera_z_mm, const std::string& settings) {
    SmallOpal small;
    small.radius_mm = 4.0;
    small.half_thickness_mm = 0.5;
    small.grains = 1;
    small.constants.sphere_diameter_nm = sphere_diameter_nm;
    OpalAsset asset = small.make();
    asset.grain_orientations = {stacking_axis_up()};
    const ScratchFolder folder;
    write_opal_asset(asset, folder / "opal.vdb");
    return render_text("[render]\nwidth = 8\nheight = 8\n[film]\naovs = [\"hkl\"]\n" + settings +
                           "[camera]\nkind = \"orthographic\"\nview_height_mm = 2\nup = [0, 1, 0]\nposition_mm = [0, 0, " +
                           std::to_string(camera_z_mm) + "]\ntarget_mm = [0, 0, 0]\n[[object]]\nkind = \"opal\"\nfile = '" +
                           (folder / "opal.vdb").string() + "'\n",
                       1)
        .image;
}

void expect_hkl(const Image& image, double h, double k, double l) {
    const float* pixel = image.pixel(3, 4) + image.find_channel("hkl.h");
    EXPECT_EQ(double(pixel[0]), h);
    EXPECT_EQ(double(pixel[1]), k);
    EXPECT_EQ(double(pixel[2]), l);
}

/// Straight down onto (111) planes: Bragg's law, lambda = 2 d n, d = sqrt(2/3) D, and the reciprocal vector points back up. Only
/// (111) has a band in the visible at that angle.
TEST(Aovs, FirstDiffractionOfAPlate) {
    const Image above = plate_hkl(250.0, 20.0, "");
    expect_hkl(above, 1.0, 1.0, 1.0);
    const OpalConstants constants;
    double wavelength_nm = 550.0;
    for (int i = 0; i < 20; ++i) {
        const double n =
            fcc_filling * constants.n_sphere.at(wavelength_nm) + (1.0 - fcc_filling) * constants.n_medium.at(wavelength_nm);
        wavelength_nm = 2.0 * std::sqrt(2.0 / 3.0) * 250.0 * n;
    }
    // The mean over a band a few nm wide, weighted by the eye's response, which is not flat.
    EXPECT_NEAR(double(above.pixel(3, 4)[above.find_channel("hkl.wavelength_nm")]), wavelength_nm, 2.0);
    expect_hkl(plate_hkl(250.0, -20.0, ""), -1.0, -1.0, -1.0);
}

TEST(Aovs, NoDiffractionWhereNoBandIsVisible) {
    expect_hkl(plate_hkl(120.0, 20.0, ""), 0.0, 0.0, 0.0);
    expect_hkl(plate_hkl(250.0, 20.0, "[opal]\ndiffraction = \"none\"\n"), 0.0, 0.0, 0.0);
}

/// A tilted plane fills the view under an orthographic camera: every value is known.
TEST(Aovs, PlaneHasItsDepthNormalAndAlbedo) {
    const Image image =
        render_text(
            "[render]\nwidth = 10\nheight = 10\n[film]\naovs = [\"depth\", \"normal\", \"albedo\", \"object_id\", "
            "\"grain_id\", \"sample_count\", \"variance\", \"depth\"]\n"
            "[camera]\nkind = \"orthographic\"\nview_height_mm = 2\nposition_mm = [0, 0, 30]\n"
            "target_mm = [0, 0, 0]\nup = [0, 1, 0]\n[[material]]\nname = \"paint\"\nalbedo = [0.7, 0.3, 0.2]\n"
            "[[object]]\nkind = \"plane\"\nmaterial = \"paint\"\nrotate_deg = [0, 60, 0]\n",
            1)
            .image;
    EXPECT_EQ(image.num_channels(), 7 + 1 + 3 + 3 + 1 + 1);
    const auto value = [&](int x, int y, const char* channel) { return double(image.pixel(x, y)[image.find_channel(channel)]); };
    for (int x = 0; x < 10; ++x) {
        // The plane turns about Y by 60 degrees: z = -x tan 60.
        EXPECT_NEAR(value(x, 2, "depth"), 30.0 + (-0.9 + 0.2 * x) * std::sqrt(3.0), 1.0e-4);
        EXPECT_NEAR(value(x, 7, "normal.X"), std::sqrt(0.75), 1.0e-6);
        EXPECT_NEAR(value(x, 7, "normal.Y"), 0.0, 1.0e-6);
        EXPECT_NEAR(value(x, 7, "normal.Z"), 0.5, 1.0e-6);
        // Colours come back from their spectra within what the table of spectra is good for.
        EXPECT_NEAR(value(x, 5, "albedo.R"), 0.7, 2.0e-3);
        EXPECT_NEAR(value(x, 5, "albedo.G"), 0.3, 2.0e-3);
        EXPECT_NEAR(value(x, 5, "albedo.B"), 0.2, 2.0e-3);
        EXPECT_EQ(value(x, 5, "object_id"), 0.0);
        EXPECT_EQ(value(x, 5, "grain_id"), 0.0);
    }
}

/// (n - 1)^2 + k^2 over (n + 1)^2 + k^2 of light that comes straight on, integrated under D65.
TEST(Aovs, MetalsHaveTheirNormalReflectance) {
    const Image image = render_text(
                            "[render]\nwidth = 4\nheight = 4\n[film]\naovs = [\"albedo\"]\n"
                            "[camera]\nkind = \"orthographic\"\nview_height_mm = 1\nposition_mm = [0, 0, 30]\n"
                            "target_mm = [0, 0, 0]\nup = [0, 1, 0]\n[[material]]\nname = \"gold\"\nkind = \"conductor\"\n"
                            "metal = \"gold\"\n[[object]]\nkind = \"plane\"\nmaterial = \"gold\"\n",
                            1)
                            .image;
    const float* albedo = image.pixel(2, 2) + image.find_channel("albedo.R");
    const SampledSpectrum light = illuminant_spectrum(IlluminantKind::d65);
    std::vector<double> reflected;
    for (int i = 0; i < colorimetric_samples; ++i) {
        const double wavelength_nm = colorimetric_min_nm + i;
        reflected.push_back(light.at(wavelength_nm) * normal_reflectance(MetalIndex::of_metal("gold").at(wavelength_nm)));
    }
    const Rgb3d expected =
        linear_srgb_from_xyz(xyz_of(std::span<const double, colorimetric_samples>(reflected.data(), colorimetric_samples)));
    EXPECT_NEAR(double(albedo[0]), expected.r, 1.0e-4);
    EXPECT_NEAR(double(albedo[1]), expected.g, 1.0e-4);
    EXPECT_NEAR(double(albedo[2]), expected.b, 1.0e-4);
    EXPECT_GT(expected.r, 2.0 * expected.b);
}

/// At the border of an object the albedo is the share of the pixel that it covers.
TEST(Aovs, AlbedoIsAveragedOverThePixel) {
    const Image image = render_text(
                            "[render]\nwidth = 4\nheight = 4\n[film]\naovs = [\"albedo\"]\n"
                            "[camera]\nkind = \"orthographic\"\nview_height_mm = 4\nposition_mm = [1.25, 0, 30]\n"
                            "target_mm = [1.25, 0, 0]\nup = [0, 1, 0]\n[[material]]\nname = \"grey\"\nalbedo = 0.5\n"
                            "[[object]]\nkind = \"plane\"\nmaterial = \"grey\"\nsize_mm = 3\n",
                            1)
                            .image;
    // Pixels are 1 mm; the plane ends at x = 1.5, a quarter into the third pixel of the row, which begins at 1.25.
    const int channel = image.find_channel("albedo.G");
    EXPECT_NEAR(image.pixel(1, 1)[channel], 0.5f, 1.0e-3f);
    EXPECT_NEAR(image.pixel(2, 1)[channel], 0.125f, 1.0e-3f);
    EXPECT_EQ(image.pixel(3, 1)[channel], 0.0f);
}

}  // namespace
}  // namespace opal
