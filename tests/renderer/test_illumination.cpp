// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>

#include "../formats/expect_error.h"
#include "color_round_trip.h"
#include "formats/illuminant.h"
#include "on_backends.h"
#include "small_opal.h"

namespace opal {
namespace {

/// Those that end with Loop are short enough to run in the devices' loop, too.
class Illumination : public OnBackends {};
class IlluminationLoop : public OnBackends {};

/// A scene whose picture shows the environment alone: one small sphere, behind the camera.
std::string bare_environment(const std::string& settings, const std::string& sampler) {
    return "[render]\nwidth = 16\nheight = 16\nfilter = \"box\"\nsampler = \"" + sampler +
           "\"\n[environment]\nkind = \"constant\"\n" + settings +
           "\n[camera]\nposition_mm = [0, -10, 0]\ntarget_mm = [0, 0, 0]\n[[material]]\nname = \"grey\"\n"
           "[[object]]\nkind = \"sphere\"\nmaterial = \"grey\"\ntranslate_mm = [0, -40, 0]\n";
}

/// The picture's mean colour, in linear sRGB, is that of the light, integrated over 1 nm, times `radiance`.
void expect_color_of(const char* backend, const std::string& settings, const SampledSpectrum& light, double radiance) {
    const Rgb3d expected = linear_srgb_from_xyz(xyz_of(light));
    const double values[3] = {expected.r, expected.g, expected.b};
    const char* const channels[3] = {"R", "G", "B"};
    for (const std::string sampler : {"independent", "stratified"}) {
        const Rendered rendered = render_text(bare_environment(settings, sampler), 256, backend);
        for (std::size_t c = 0; c < 3; ++c) {
            const MeanEstimate mean = region_mean(rendered.image, channels[c], 0, 0, 16, 16);
            // The variance of independent samples bounds that of stratified ones.
            EXPECT_NEAR(mean.mean, radiance * values[c], 4.0 * mean.standard_error) << settings << sampler << channels[c];
            EXPECT_LT(mean.standard_error, 0.01 * radiance);
        }
    }
}

TEST_P(Illumination, ConstantEnvironmentHasItsIlluminantsColor) {
    expect_color_of(GetParam(), "", illuminant_spectrum(IlluminantKind::d65), 1.0);
    expect_color_of(GetParam(), "illuminant = \"A\"\nradiance = 2.5", illuminant_spectrum(IlluminantKind::a), 2.5);
    expect_color_of(GetParam(), "illuminant = \"blackbody\"\ntemperature_k = 3200",
                    illuminant_spectrum(IlluminantKind::blackbody, 3200.0), 1.0);
    expect_color_of(GetParam(), "illuminant = \"led\"\ntemperature_k = 5000", illuminant_spectrum(IlluminantKind::led, 5000.0),
                    1.0);
}

TEST_P(Illumination, ConstantEnvironmentFromAFile) {
    const ScratchFolder folder;
    std::ofstream(folder / "lamp.csv") << "wavelength_nm,power\n400,0.1\n546,1\n548,5\n550,1\n700,0.4\n";
    const SampledSpectrum lamp = illuminant_spectrum(IlluminantKind::file, 0.0, folder / "lamp.csv");
    expect_color_of(GetParam(), "illuminant_file = '" + (folder / "lamp.csv").string() + "'", lamp, 1.0);
}

/// Spectral layers show the light itself, whatever white the picture is adapted to.
TEST_P(Illumination, FilmsWhiteIsNeutralAndLeavesSpectraAlone) {
    const char* const channels[3] = {"R", "G", "B"};
    for (const std::string white : {"A", "E", "D65"}) {
        const std::string settings = "illuminant = \"" + white + "\"\n[film]\nspectral = true\nwhite = ";
        const Rendered adapted = render_text(bare_environment(settings + "\"" + white + "\"", "independent"), 256, GetParam());
        const Rendered plain = render_text(bare_environment(settings + "\"D65\"", "independent"), 256, GetParam());
        for (const char* channel : channels) {
            const MeanEstimate mean = region_mean(adapted.image, channel, 0, 0, 16, 16);
            EXPECT_NEAR(mean.mean, 1.0, 4.0 * mean.standard_error) << white << channel;
        }
        for (const std::string layer : {"S0.450nm", "S0.550nm", "S0.650nm"})
            EXPECT_EQ(region_mean(adapted.image, layer, 0, 0, 16, 16).mean, region_mean(plain.image, layer, 0, 0, 16, 16).mean);
    }
}

/// A diffuse plane fills the view under uniform light: it shows the colour that its spectrum has under that light.
TEST_P(IlluminationLoop, DiffusePlaneShowsItsAlbedo) {
    const char* const channels[3] = {"R", "G", "B"};
    const std::pair<std::string, Upsampling> methods[] = {
        {"jakob-hanika", Upsampling::jakob_hanika}, {"smits", Upsampling::smits}, {"basis", Upsampling::basis}};
    for (const auto& [name, upsampling] : methods) {
        const Rendered rendered = render_text(
            "[render]\nwidth = 16\nheight = 16\nfilter = \"box\"\nsampler = \"independent\"\n[color]\nupsampling = \"" + name +
                "\"\n[environment]\nkind = \"constant\"\nilluminant = \"A\"\n[camera]\nposition_mm = [0, -10, 40]\n"
                "target_mm = [0, 0, 0]\n[[material]]\nname = \"paint\"\nalbedo = [0.8, 0.35, 0.1]\n[[object]]\n"
                "kind = \"plane\"\nmaterial = \"paint\"\n",
            256, GetParam());
        SpectrumTableOptions options;
        options.upsampling = upsampling;
        const ReflectanceTable reflectance = reflectance_table(make_spectrum_tables(options), {0.8f, 0.35f, 0.1f});
        const std::vector<double> light = colorimetric_table(illuminant_spectrum(IlluminantKind::a));
        const Rgb3d expected =
            linear_srgb_from_xyz(xyz_of_product(reflectance, std::span<const double, colorimetric_samples>(light)));
        const double values[3] = {expected.r, expected.g, expected.b};
        for (std::size_t c = 0; c < 3; ++c) {
            const MeanEstimate mean = region_mean(rendered.image, channels[c], 0, 0, 16, 16);
            EXPECT_NEAR(mean.mean, values[c], 4.0 * mean.standard_error) << name << channels[c];
            EXPECT_LT(mean.standard_error, 0.02);
        }
    }
}

TEST(BadLights, AreRefused) {
    const ScratchFolder folder;
    std::ofstream(folder / "broken.csv") << "400,1\n390,1\n";
    EXPECT_INPUT_ERROR(
        render_text(bare_environment("illuminant_file = '" + (folder / "broken.csv").string() + "'", "independent"), 1),
        "broken.csv:2: wavelengths must");
    EXPECT_INPUT_ERROR(render_text(bare_environment("illuminant = \"file\"", "independent"), 1), "illuminant_file");
    EXPECT_INPUT_ERROR(render_text(bare_environment("illuminant = \"led\"\ntemperature_k = 1200", "independent"), 1),
                       "temperature_k");
    EXPECT_INPUT_ERROR(render_text(bare_environment("illuminant = \"D56\"", "independent"), 1), "did you mean 'D65'");
    EXPECT_INPUT_ERROR(render_text(bare_environment("illuminant = \"A\"\ntemperature_k = 3000", "independent"), 1),
                       "temperature_k");
    EXPECT_INPUT_ERROR(render_text(bare_environment("[color]\nupsampling = \"meng\"", "independent"), 1), "upsampling");
}

INSTANTIATE_TEST_SUITE_P(, Illumination, cpu_and_cuda(), backend_name);
INSTANTIATE_TEST_SUITE_P(, IlluminationLoop, cpu_loop_and_cuda(), backend_name);

}  // namespace
}  // namespace opal
