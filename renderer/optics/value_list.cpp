// SPDX-License-Identifier: Apache-2.0
#include "renderer/optics/value_list.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "formats/error.h"

namespace opal {
namespace {

constexpr double most_values = 1.0e6;

/// The numbers between separators; empty where a part is not a finite number.
std::vector<double> split_numbers(const std::string& text, char separator) {
    std::vector<double> numbers;
    const char* rest = text.c_str();
    while (true) {
        char* end = nullptr;
        const double number = std::strtod(rest, &end);
        if (end == rest || !std::isfinite(number) || (*end != separator && *end != '\0')) return {};
        numbers.push_back(number);
        if (*end == '\0') return numbers;
        rest = end + 1;
    }
}

std::vector<double> expand_range(const std::string& flag, const std::string& text) {
    const std::vector<double> parts = split_numbers(text, ':');
    if (parts.size() != 3 || !(parts[2] > 0.0) || parts[1] < parts[0])
        throw InputError(fmt::format("{} {}: expected first:last:step with last >= first and step > 0", flag, text));
    // A last value that the steps meet but for rounding belongs to the range.
    const double steps = std::floor((parts[1] - parts[0]) / parts[2] + 1.0e-9);
    if (steps >= most_values) throw InputError(fmt::format("{} {}: more than a million values", flag, text));
    std::vector<double> values;
    for (double step = 0.0; step <= steps; step += 1.0) values.push_back(parts[0] + step * parts[2]);
    return values;
}

}  // namespace

std::vector<double> parse_values(const std::string& flag, const std::string& text, double low, double high) {
    const std::vector<double> values = text.find(':') != std::string::npos ? expand_range(flag, text) : split_numbers(text, ',');
    if (values.empty())
        throw InputError(fmt::format("{} {}: expected a number, a list a,b,c or a range first:last:step", flag, text));
    for (const double value : values)
        if (!(value >= low && value <= high))
            throw InputError(fmt::format("{} {}: {:.10g} is out of range; allowed: {:g} to {:g}", flag, text, value, low, high));
    return values;
}

}  // namespace opal
