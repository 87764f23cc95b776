// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <string>

namespace opal {

/// Check of an option: a number between two others. CLI11's own range lets NaN pass.
inline CLI::Validator number_between(double low, double high) {
    return CLI::Validator(
        [low, high](const std::string& text) {
            char* end = nullptr;
            const double value = std::strtod(text.c_str(), &end);
            const bool allowed = end != text.c_str() && *end == '\0' && value >= low && value <= high;
            return allowed ? std::string() : fmt::format("{} is not a number from {} to {}", text, low, high);
        },
        fmt::format("NUMBER from {} to {}", low, high));
}

}  // namespace opal
