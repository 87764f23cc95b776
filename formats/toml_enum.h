// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "formats/toml_reader.h"

namespace opal {

/// Reads one of `names` as the enumerator of the same place.
template <typename Enum>
Enum enum_choice(TomlSection& section, const std::string& key, Enum fallback, const std::vector<std::string>& names) {
    const std::string name = section.choice(key, names[static_cast<std::size_t>(fallback)], names);
    return static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
}

inline std::string vector_text(const std::array<double, 3>& v) {
    return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]);
}

}  // namespace opal
