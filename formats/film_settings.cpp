// SPDX-License-Identifier: Apache-2.0
#include "formats/film_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>

#include "formats/error.h"
#include "formats/illuminant.h"
#include "formats/text.h"
#include "formats/toml_enum.h"

namespace opal {
namespace {

// In the order of IlluminantKind.
const std::vector<std::string> white_names = {"D65", "A", "E", "blackbody"};

}  // namespace

const std::vector<std::string> tone_names = {"filmic", "srgb", "none"};
const std::vector<std::string> aov_names = {"object_id", "grain_id", "depth",        "normal",
                                            "albedo",    "hkl",      "sample_count", "variance"};

FilmDescription read_film(TomlSection section) {
    FilmDescription film;
    film.spectral = section.boolean("spectral", film.spectral);
    film.aovs = section.choices("aovs", aov_names);
    film.exposure_ev = section.number("exposure_ev", film.exposure_ev, NumberRange::between(-40.0, 40.0));
    const bool has_temperature = section.has("white_temperature_k");
    film.white = enum_choice(section, "white", has_temperature ? IlluminantKind::blackbody : film.white, white_names);
    if ((film.white == IlluminantKind::blackbody) != has_temperature)
        section.fail("white_temperature_k", "and white = \"blackbody\" go together");
    film.white_temperature_k =
        section.number("white_temperature_k", film.white_temperature_k, NumberRange::between(white_min_k, white_max_k));
    film.tone = enum_choice(section, "tone", film.tone, tone_names);
    section.finish();
    return film;
}

std::string film_to_toml(const FilmDescription& film) {
    std::string text = fmt::format("spectral = {}\naovs = [{}]\nexposure_ev = {}\nwhite = \"{}\"\n", film.spectral,
                                   film.aovs.empty() ? "" : fmt::format("\"{}\"", fmt::join(film.aovs, "\", \"")),
                                   film.exposure_ev, white_names[static_cast<std::size_t>(film.white)]);
    if (film.white == IlluminantKind::blackbody) text += fmt::format("white_temperature_k = {}\n", film.white_temperature_k);
    return text + fmt::format("tone = \"{}\"\n", tone_names[static_cast<std::size_t>(film.tone)]);
}

FilmDescription parse_film(const std::string& text, const std::string& name) {
    return read_film(TomlDocument(text, name, {}).root());
}

void set_white(FilmDescription& film, const std::string& white, const std::string& where) {
    if (!white.empty() && white.back() == 'K') {
        char* end = nullptr;
        const double kelvin = std::strtod(white.c_str(), &end);
        if (end == white.c_str() + white.size() - 1 && kelvin >= white_min_k && kelvin <= white_max_k) {
            film.white = IlluminantKind::blackbody;
            film.white_temperature_k = kelvin;
            return;
        }
    }
    const std::vector<std::string> named(white_names.begin(), white_names.begin() + 3);
    for (std::size_t i = 0; i < named.size(); ++i)
        if (white == named[i]) {
            film.white = static_cast<IlluminantKind>(i);
            return;
        }
    throw InputError(fmt::format("{} {}: allowed: {} or a black body's temperature from {:g}K to {:g}K", where, white,
                                 join(named), white_min_k, white_max_k));
}

Xyz film_white(const FilmDescription& film) {
    return xyz_of(illuminant_spectrum(film.white, film.white_temperature_k));
}

}  // namespace opal
