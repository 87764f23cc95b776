// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "formats/colorimetry.h"
#include "formats/scene.h"
#include "formats/toml_reader.h"

/// The [film] section of a scene: what a picture's file holds and how its PNG is developed.
namespace opal {

/// Black-body temperatures that a film's white can have.
inline constexpr double white_min_k = 1000.0, white_max_k = 25000.0;

extern const std::vector<std::string> tone_names;
/// What film.aovs may hold.
extern const std::vector<std::string> aov_names;

FilmDescription read_film(TomlSection section);
/// The section's keys, every default spelled out; `read_film` reads them back.
std::string film_to_toml(const FilmDescription& film);
/// The same from the text of the keys; `name` stands for the file in messages.
FilmDescription parse_film(const std::string& text, const std::string& name);

/// "D65", "A", "E" or a black-body temperature such as "3200K" into `film`; throws InputError, `where` being the flag's or key's
/// name.
void set_white(FilmDescription& film, const std::string& white, const std::string& where);
/// XYZ, Y = 1, of what the film shows as white.
Xyz film_white(const FilmDescription& film);

}  // namespace opal
