// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace opal {

/// The candidate nearest to `name` by edit distance, or an empty string where none is near enough to be a likely slip.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

/// "a, b, c".
std::string join(const std::vector<std::string>& names, std::string_view separator = ", ");

/// "[x, y, z]", as TOML has it.
std::string vector_text(const std::array<double, 3>& v);

/// A TOML basic string: quoted, with what needs it escaped.
std::string toml_quoted(std::string_view text);

/// The text on one line of a terminal: control characters, which a file or a library may have put into it, are written as \n, \t
/// or \x1b.
std::string one_line(std::string_view text);

/// "; did you mean 'x'?" or "", ready to append to a message.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace opal
