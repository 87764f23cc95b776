// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace opal {

/// Rows of a .csv of numbers beside the tests: lines with # and the header line are skipped.
inline std::vector<std::vector<double>> read_reference_table(const std::string& name) {
    std::ifstream stream(std::string(OPAL_OPTICS_REFERENCE) + "/" + name);
    EXPECT_TRUE(stream.good()) << name;
    std::vector<std::vector<double>> rows;
    std::string line;
    bool header = true;
    while (std::getline(stream, line)) {
        if (line.empty() || line[0] == '#') continue;
        if (!header) {
            rows.emplace_back();
            std::istringstream cells(line);
            for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
        }
        header = false;
    }
    return rows;
}

}  // namespace opal
