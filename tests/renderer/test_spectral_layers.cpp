// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <regex>

#include "formats/film_settings.h"
#include "small_opal.h"

namespace opal {
namespace {

/// Names and attributes of Fichet, Pacanowski & Wilkie 2021, "An OpenEXR layout for spectral images", JCGT 10(3).
TEST(SpectralLayers, FollowThePublishedLayout) {
    const Image image = Film(4, 3, true).to_image();
    const std::regex emissive(R"(S0\.(\d*,?\d*([Ee][+-]?\d+)?)(Y|Z|E|P|T|G|M|k|h|da|d|c|m|u|n|p)?(m|Hz))");
    int layers = 0;
    for (const std::string& name : image.channel_names)
        if (name.starts_with("S0")) {
            EXPECT_TRUE(std::regex_match(name, emissive)) << name;
            EXPECT_EQ(name, "S0." + std::to_string(360 + 10 * layers) + "nm");
            ++layers;
        }
    EXPECT_EQ(layers, num_bins);
    EXPECT_EQ(image.attributes.at("spectralLayoutVersion"), "1.0");
    EXPECT_EQ(image.attributes.at("emissiveUnits"), "W.m^-2.sr^-1");
    EXPECT_TRUE(Film(4, 3, false).to_image().attributes.empty());
}

/// Mean of the colour matching functions over a layer's wavelengths, times its width.
Vec3 layer_response(const SpectrumTables& tables, int bin) {
    const double low = std::max(360.0, bin_centre_nm(bin) - 5.0), high = std::min(830.0, bin_centre_nm(bin) + 5.0);
    constexpr int steps = 400;
    double sum[3] = {};
    for (int i = 0; i < steps; ++i) {
        const Vec3 value = table_at(tables.observer, float(low + (high - low) * (i + 0.5) / steps));
        sum[0] += double(value.x);
        sum[1] += double(value.y);
        sum[2] += double(value.z);
    }
    const double width = (high - low) / steps;
    return {float(width * sum[0]), float(width * sum[1]), float(width * sum[2])};
}

/// Light of a flat spectrum is flat within each layer, so that layers times the observer's means are the picture's colour but
/// for chance; both come from the same samples.
TEST(SpectralLayers, IntegrateToTheColour) {
    const std::string text =
        "[render]\nwidth = 24\nheight = 24\nfilter = \"box\"\n[film]\nspectral = true\n"
        "[environment]\nkind = \"constant\"\nilluminant = \"E\"\nradiance = 3\n"
        "[camera]\nposition_mm = [0, -10, 0]\ntarget_mm = [0, 0, 0]\n[[material]]\nname = \"grey\"\n"
        "[[object]]\nkind = \"sphere\"\nmaterial = \"grey\"\ntranslate_mm = [0, -40, 0]\n";
    const Rendered rendered = render_text(text, 256);
    const SpectrumTablesData tables = make_spectrum_tables({});
    Xyz sum = {0.0, 0.0, 0.0};
    for (int bin = 0; bin < num_bins; ++bin) {
        const Vec3 response = layer_response(tables.view(), bin);
        const double mean = region_mean(rendered.image, "S0." + std::to_string(360 + 10 * bin) + "nm", 0, 0, 24, 24).mean;
        sum = {sum.x + mean * double(response.x), sum.y + mean * double(response.y), sum.z + mean * double(response.z)};
    }
    const Rgb3d rgb = linear_srgb_from_xyz(sum);
    const char* const channels[3] = {"R", "G", "B"};
    const double values[3] = {rgb.r, rgb.g, rgb.b};
    for (std::size_t c = 0; c < 3; ++c) {
        const MeanEstimate mean = region_mean(rendered.image, channels[c], 0, 0, 24, 24);
        EXPECT_NEAR(values[c], mean.mean, 4.0 * mean.standard_error) << channels[c];
        EXPECT_LT(mean.standard_error, 0.01 * mean.mean);
    }
}

}  // namespace
}  // namespace opal
