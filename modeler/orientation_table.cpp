// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "formats/error.h"
#include "modeler/orientations.h"

namespace opal {
namespace {

constexpr double allowed_length_error = 1.0e-3;

struct TableRow {
    double number[5];  ///< grain, x, y, z, w
};

/// Five numbers with commas between them; false where the line is anything else.
bool read_row(const std::string& line, TableRow& row) {
    const char* text = line.c_str();
    for (int n = 0; n < 5; ++n) {
        char* end = nullptr;
        row.number[n] = std::strtod(text, &end);
        if (end == text || !std::isfinite(row.number[n])) return false;
        while (*end == ' ' || *end == '\t' || *end == '\r') ++end;
        if (*end != (n < 4 ? ',' : '\0')) return false;
        text = end + 1;
    }
    return true;
}

void take_row(const TableRow& row, const std::string& where, std::vector<Orientation>& orientations, std::vector<char>& given) {
    const auto& [grain, x, y, z, w] = row.number;
    const auto num_grains = static_cast<double>(orientations.size());
    if (!(grain >= 1.0 && grain <= num_grains) || grain != std::floor(grain))
        throw InputError(fmt::format("{}: grain {} is not there; this opal's grains are 1 to {}", where, grain, num_grains));
    const double length = std::sqrt(x * x + y * y + z * z + w * w);
    if (!(std::abs(length - 1.0) <= allowed_length_error))
        throw InputError(
            fmt::format("{}: the quaternion's length is {:.6g}; allowed: 1 within {}", where, length, allowed_length_error));
    const auto n = static_cast<std::size_t>(grain) - 1;
    if (given[n] != 0) throw InputError(fmt::format("{}: grain {} is given a second time", where, grain));
    given[n] = 1;
    orientations[n] = Orientation(float(x / length), float(y / length), float(z / length), float(w / length));
}

}  // namespace

std::vector<Orientation> read_orientation_table(const std::filesystem::path& file, std::int32_t num_grains) {
    std::ifstream stream(file);
    if (!stream) throw InputError(fmt::format("{}: no such file, or it cannot be read", file.string()));
    std::vector<Orientation> orientations(static_cast<std::size_t>(num_grains));
    std::vector<char> given(orientations.size(), 0);
    std::string line;
    bool names_allowed = true;
    for (int number = 1; std::getline(stream, line); ++number) {
        const std::size_t start = line.find_first_not_of(" \t\r");
        if (start == std::string::npos || line[start] == '#') continue;
        TableRow row;
        const bool is_row = read_row(line, row);
        const bool is_names = !is_row && names_allowed && line.find_first_of("0123456789") == std::string::npos;
        names_allowed = false;
        if (is_names) continue;
        const std::string where = fmt::format("{}:{}", file.string(), number);
        if (!is_row) throw InputError(fmt::format("{}: expected 'grain,x,y,z,w'", where));
        take_row(row, where, orientations, given);
    }
    for (std::size_t n = 0; n < given.size(); ++n)
        if (given[n] == 0)
            throw InputError(fmt::format("{}: no orientation of grain {}; every grain from 1 to {} needs one", file.string(),
                                         n + 1, num_grains));
    return orientations;
}

}  // namespace opal
