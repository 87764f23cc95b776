// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "formats/toml_reader.h"

namespace opal {

/// A key whose value is one of `names`, which stand in the order of the enumeration.
template <typename Enum>
Enum enum_choice(TomlSection& section, const std::string& key, Enum fallback, const std::vector<std::string>& names) {
    const std::string name = section.choice(key, names[static_cast<std::size_t>(fallback)], names);
    return static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
}

}  // namespace opal
