// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace opal {

/// Any text as one word of a POSIX shell's command.
inline std::string shell_word(const std::string& text) {
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

}  // namespace opal
