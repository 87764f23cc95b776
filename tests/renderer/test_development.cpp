// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "../formats/expect_error.h"
#include "formats/film_settings.h"
#include "renderer/host/contact_sheet.h"
#include "renderer/host/development.h"
#include "renderer/host/tone_mapping.h"

namespace opal {
namespace {

FilmDescription film(const std::string& keys) {
    return parse_film(keys, "test");
}

Image one_pixel(Rgb3d color) {
    Image image;
    image.width = image.height = 1;
    image.channel_names = {"B", "G", "R"};
    image.pixels = {float(color.b), float(color.g), float(color.r)};
    return image;
}

TEST(Development, SettingsOfTheSceneGiveTheBitsOfItsToneMapping) {
    const Image image = one_pixel({0.7, 0.31, 0.09});
    for (const char* keys : {"", "exposure_ev = 1.3\ntone = \"srgb\"\n", "white = \"A\"\n", "white_temperature_k = 4000\n"})
        EXPECT_EQ(developed(image, film(keys), film(keys), "a.exr").pixels,
                  tone_mapped(image, film(keys).exposure_ev, film(keys).tone).pixels);
}

/// A grey card under each light, taken with the film set to another: shown with the light as white it is grey.
TEST(Development, WhiteBalanceMakesTheLightNeutral) {
    for (const char* taken_keys : {"", "white = \"E\"\n", "white_temperature_k = 9000\n"})
        for (const char* light_keys : {"white = \"A\"\n", "white_temperature_k = 5000\n", ""}) {
            const FilmDescription taken = film(taken_keys), light = film(light_keys);
            Xyz card = film_white(light);
            card = {0.2 * card.x, 0.2 * card.y, 0.2 * card.z};
            const Image seen = one_pixel(linear_srgb_from_xyz(bradford_adaptation(film_white(taken), srgb_white) * card));
            const Image balanced = white_balanced(seen, taken, light);
            for (const float c : balanced.pixels) EXPECT_NEAR(c, 0.2f, 2.0e-6f) << taken_keys << light_keys;
        }
}

TEST(Development, WhiteBalanceAndBackIsTheSame) {
    const FilmDescription day = film(""), lamp = film("white = \"A\"\n");
    const Image image = one_pixel({0.7, 0.31, 0.09});
    const Image back = white_balanced(white_balanced(image, day, lamp), lamp, day);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(back.pixels[c], image.pixels[c], 1.0e-6f);
}

TEST(Development, ToneCurves) {
    const Image image = one_pixel({0.9, 0.4, 0.1});
    const Image srgb = tone_mapped(image, 1.0, ToneCurve::srgb), none = tone_mapped(image, 1.0, ToneCurve::none);
    EXPECT_EQ(srgb.pixels[0], 1.0f);
    EXPECT_EQ(srgb.pixels[1], float(srgb_encoded(double(0.8f))));
    EXPECT_EQ(none.pixels[0], 1.0f);
    EXPECT_EQ(none.pixels[1], 0.8f);
    EXPECT_EQ(none.pixels[2], 0.2f);
    EXPECT_LT(tone_mapped(image, 1.0).pixels[0], 1.0f);
}

TEST(Development, HeaderTellsHowThePictureWasTaken) {
    Image image = one_pixel({1.0, 1.0, 1.0});
    EXPECT_EQ(film_to_toml(film_of_image(image, "a.exr")), film_to_toml({}));
    image.attributes[film_attribute] = film_to_toml(film("white = \"A\"\nexposure_ev = 2\n"));
    EXPECT_EQ(film_of_image(image, "a.exr").white, IlluminantKind::a);
    EXPECT_EQ(film_of_image(image, "a.exr").exposure_ev, 2.0);
    image.attributes[film_attribute] = "white = 3\n";
    EXPECT_INPUT_ERROR(film_of_image(image, "a.exr"), "a.exr: opal:film");
    image.channel_names[0] = "Y";
    EXPECT_INPUT_ERROR(developed(image, {}, {}, "a.exr"), "a.exr: has no channel B");
}

TEST(Development, CropsOfCropsKeepTheirPlace) {
    Image image;
    image.width = 8;
    image.height = 5;
    image.channel_names = {"R", "G", "B"};
    for (int i = 0; i < 8 * 5 * 3; ++i) image.pixels.push_back(float(i));
    const Image once = cropped(image, {2, 1, 7, 5}, "--crop"), twice = cropped(once, {3, 2, 5, 4}, "--crop");
    EXPECT_EQ(twice.x0, 3);
    EXPECT_EQ(twice.full_width, 8);
    EXPECT_EQ(twice.full_height, 5);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x) EXPECT_EQ(twice.pixel(x, y)[2], image.pixel(3 + x, 2 + y)[2]);
    EXPECT_INPUT_ERROR(cropped(once, {1, 2, 5, 4}, "--crop"), "--crop 1,2,5,4: the picture holds x 2 to 7, y 1 to 5");
    EXPECT_INPUT_ERROR(cropped(image, {0, 0, 9, 1}, "--crop"), "the picture holds");
    EXPECT_INPUT_ERROR(cropped(image, {4, 0, 4, 1}, "--crop"), "the picture holds");
}

TEST(ContactSheet, TilesShowTheMeansOfTheirPictures) {
    ContactSheet sheet(3, 400, 200, 100);
    for (const float value : {0.25f, 0.5f, 1.0f}) {
        Image picture;
        picture.width = 400;
        picture.height = 200;
        picture.channel_names = {"R", "G", "B"};
        for (int i = 0; i < 400 * 200; ++i) {
            const float stripe = i % 2 == 0 ? value : 0.0f;
            picture.pixels.insert(picture.pixels.end(), {stripe, value, 0.5f * value});
        }
        sheet.add(picture, "x");
    }
    const Image& image = sheet.image();
    EXPECT_EQ(image.width, 2 * (100 + 4) + 4);
    EXPECT_EQ(image.height, 2 * (50 + 4 + 16) + 4);
    const auto expect_tile = [&](int left, int top, float value) {
        for (const auto& [x, y] : {std::pair{left, top}, std::pair{left + 99, top + 49}}) {
            EXPECT_NEAR(image.pixel(x, y)[0], 0.5f * value, 1.0e-5f);
            EXPECT_NEAR(image.pixel(x, y)[1], value, 1.0e-5f);
        }
    };
    expect_tile(4, 4, 0.25f);
    expect_tile(108, 4, 0.5f);
    expect_tile(4, 74, 1.0f);
    EXPECT_THROW(sheet.add(image, "one too many"), std::out_of_range);
}

}  // namespace
}  // namespace opal
