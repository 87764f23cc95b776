// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "expect_error.h"
#include "formats/film_settings.h"
#include "formats/illuminant.h"

namespace opal {
namespace {

TEST(FilmSettings, TextReadsBack) {
    for (const std::string keys : {"", "white = \"A\"\ntone = \"srgb\"\n", "white_temperature_k = 3200.5\nexposure_ev = -1.25\n",
                                   "spectral = true\naovs = [\"hkl\", \"albedo\"]\nwhite = \"E\"\ntone = \"none\"\n"}) {
        const std::string text = film_to_toml(parse_film(keys, "test"));
        EXPECT_EQ(film_to_toml(parse_film(text, "test")), text);
    }
    EXPECT_INPUT_ERROR(parse_film("white = \"blackbody\"\n", "test"), "go together");
    EXPECT_INPUT_ERROR(parse_film("white = \"A\"\nwhite_temperature_k = 3000\n", "test"), "go together");
    EXPECT_INPUT_ERROR(parse_film("white_temperature_k = 300\n", "test"), "out of range");
    EXPECT_INPUT_ERROR(parse_film("aovs = [\"dept\"]\n", "test"), "did you mean 'depth'?");
}

TEST(FilmSettings, WhiteByNameOrTemperature) {
    FilmDescription film;
    EXPECT_NEAR(film_white(film).x, srgb_white.x, 1.0e-4);
    set_white(film, "E", "--white");
    EXPECT_NEAR(film_white(film).z, 1.0, 2.0e-3);
    set_white(film, "2856K", "--white");
    EXPECT_NEAR(correlated_color_temperature(chromaticity_of(film_white(film))).temperature_k, 2856.0, 2.0);
    for (const char* bad : {"", "F", "d65", "K", "5000", "900K", "30000K", "5000KK", "nanK"})
        EXPECT_INPUT_ERROR(set_white(film, bad, "--white"), "allowed: D65, A, E or a black body's temperature");
}

}  // namespace
}  // namespace opal
