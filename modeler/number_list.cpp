// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/number_list.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

#include "formats/error.h"

namespace opal {

std::vector<double> read_number_list(const std::filesystem::path& file) {
    std::ifstream stream(file);
    if (!stream) throw InputError(fmt::format("{}: no such file, or it cannot be read", file.string()));
    std::vector<double> numbers;
    std::string line;
    bool heading_allowed = true;
    for (int number = 1; std::getline(stream, line); ++number) {
        const std::size_t start = line.find_first_not_of(" \t\r");
        if (start == std::string::npos || line[start] == '#') continue;
        char* end = nullptr;
        const double value = std::strtod(line.c_str(), &end);
        const bool begins_with_number = end != line.c_str();
        const bool ends_there = std::string(end).find_first_not_of(" \t\r") == std::string::npos;
        if (begins_with_number && ends_there && std::isfinite(value))
            numbers.push_back(value);
        else if (!heading_allowed || begins_with_number)
            throw InputError(fmt::format("{}:{}: expected one finite number, found '{}'", file.string(), number,
                                         line.substr(start, line.find_last_not_of(" \t\r") + 1 - start)));
        heading_allowed = false;
    }
    return numbers;
}

}  // namespace opal
