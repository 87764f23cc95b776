// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "formats/error.h"
#include "plane_scene.h"
#include "renderer/host/film_parts.h"
#include "renderer/host/render_fingerprint.h"
#include "small_opal.h"

namespace opal {
namespace {

constexpr int all_samples = 48;

void write_part(const PlaneScene& scene, SampleRange range, const std::filesystem::path& path, int drawn = 0) {
    const auto film = scene.film(range.first);
    scene.render(*film, drawn > 0 ? drawn : int(range.end));
    Image image = film->to_image();
    image.attributes[samples_attribute] = sample_ranges_text({range});
    image.attributes[all_samples_attribute] = std::to_string(all_samples);
    image.attributes[fingerprint_attribute] = render_fingerprint(scene.description);
    image.attributes["opal:command"] = "opal-render plane.toml";
    add_exact_sums(*film, image);
    write_exr(path, image);
}

/// The message of the InputError that something ends in; empty where it does not.
std::string refusal(const std::function<void()>& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// Each sum is a double: adding up in another order changes it by some 1e-16 of itself, and the float made of it once in 1e8
/// times. A picture of 720 pixels and 55 channels has 4e4 of them.
TEST(FilmParts, TogetherAreTheWhole) {
    const PlaneScene scene;
    const ScratchFolder folder;
    const auto film = scene.film();
    scene.render(*film, all_samples);
    const Image whole = film->to_image();
    write_part(scene, {0, 5}, folder / "a.exr");
    write_part(scene, {5, 32}, folder / "b.exr");
    write_part(scene, {32, 48}, folder / "c.exr");

    PartMerger merger(read_part(folder / "c.exr"));
    merger.add(read_part(folder / "a.exr"));
    EXPECT_EQ(sample_ranges_text(merger.missing()), "5:32");
    // What is there so far can be written, read back and merged on.
    write_exr(folder / "some.exr", merger.merged());
    PartMerger rest(read_part(folder / "some.exr"));
    rest.add(read_part(folder / "b.exr"));
    EXPECT_TRUE(rest.missing().empty());
    const Image merged = rest.merged();
    ASSERT_EQ(merged.channel_names.size(), whole.channel_names.size());
    std::size_t different = 0;
    for (int y = 0; y < whole.height; ++y)
        for (int x = 0; x < whole.width; ++x)
            for (int c = 0; c < whole.num_channels(); ++c) {
                const float a = whole.pixel(x, y)[c];
                const float b = merged.pixel(x, y)[merged.find_channel(whole.channel_names[std::size_t(c)])];
                if (a == b) continue;
                ++different;
                EXPECT_EQ(std::nextafter(a, b), b) << whole.channel_names[std::size_t(c)];
            }
    EXPECT_LE(different, 1u);
    EXPECT_TRUE(merged.words.empty());
    EXPECT_EQ(merged.attributes.count(samples_attribute), 0u);
    EXPECT_EQ(merged.attributes.at("opal:command"), "opal-render plane.toml");
}

TEST(FilmParts, WhatDoesNotBelongTogetherIsRefused) {
    const PlaneScene scene, other({"camera.vertical_fov_deg=25"});
    const ScratchFolder folder;
    write_part(scene, {0, 16}, folder / "a.exr");
    write_part(scene, {12, 32}, folder / "overlapping.exr");
    write_part(other, {16, 32}, folder / "other.exr");
    write_part(scene, {16, 32}, folder / "unfinished.exr", 24);
    const auto plain = scene.film();
    scene.render(*plain, 2);
    write_exr(folder / "plain.exr", plain->to_image());
    PartMerger merger(read_part(folder / "a.exr"));
    EXPECT_NE(refusal([&] { merger.add(read_part(folder / "overlapping.exr")); }).find("samples 12:32 overlap 0:16 of"),
              std::string::npos);
    EXPECT_NE(refusal([&] { merger.add(read_part(folder / "other.exr")); }).find("camera.vertical_fov_deg is 20"),
              std::string::npos);
    EXPECT_NE(refusal([&] { read_part(folder / "unfinished.exr"); }).find("has 8 of the 16 samples"), std::string::npos);
    EXPECT_NE(refusal([&] { read_part(folder / "plain.exr"); }).find("made without --samples"), std::string::npos);
}

TEST(FilmParts, RangesAsText) {
    EXPECT_EQ(sample_ranges_text(parse_sample_ranges("0:16,32:48", "--samples")), "0:16,32:48");
    for (const char* wrong : {"", "16", "16:", ":16", "16:16", "5:2", "-1:4", "0:16,", "0:99999999", "0:16 ", "a:b"})
        EXPECT_THROW(parse_sample_ranges(wrong, "--samples"), InputError) << wrong;
}

TEST(RenderFingerprint, TellsWhatDiffers) {
    const auto of = [](const std::vector<std::string>& overrides) { return render_fingerprint(plane_description(overrides)); };
    const std::string fingerprint = of({});
    // How many samples there are and how they are shown is free.
    EXPECT_EQ(fingerprint, of({"render.samples=7", "film.exposure_ev=1.5", "film.aovs=[\"depth\"]"}));
    const auto difference = [&](const std::vector<std::string>& overrides) {
        return fingerprint_difference(fingerprint, "one", of(overrides), "two");
    };
    EXPECT_EQ(difference({}), "");
    EXPECT_EQ(difference({"render.seed=2"}), "render.seed is 1 in one and 2 in two");
    EXPECT_EQ(difference({"object.1.radius_mm=5"}), "object.1.radius_mm is 4 in one and 5 in two");
    EXPECT_NE(difference({"render.noise=0.1"}), "");
}

/// Files count by their content, wherever they lie.
TEST(RenderFingerprint, KnowsFilesByTheirContent) {
    const ScratchFolder folder;
    const auto of = [&](const std::string& name, const std::string& content) {
        std::ofstream(folder / name) << content;
        return render_fingerprint(
            parse_scene("[environment]\nilluminant_file = '" + (folder / name).string() +
                            "'\n[[material]]\nname = \"m\"\n[[object]]\nkind = \"plane\"\nmaterial = \"m\"\n",
                        "scene.toml", {}));
    };
    const std::string light = "wavelength_nm,power\n400,1\n700,1\n";
    EXPECT_EQ(of("a.csv", light), of("b.csv", light));
    EXPECT_NE(of("a.csv", light), of("b.csv", light + "710,1\n"));
}

}  // namespace
}  // namespace opal
