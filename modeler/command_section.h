// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace opal {

struct SectionArguments {
    std::vector<std::string> files;
    std::string output_file;
    std::string axis = "z";
    std::string at_mm;
    int slices = 1;
    std::string color = "grain";
    int size_px = 0;
};

/// Adds `opal-model section`.
CLI::App* add_section(CLI::App& app, SectionArguments& arguments);

/// Cuts the opals and writes the picture. Throws InputError for files, places and colourings that are not there.
int run_section(const SectionArguments& arguments);

}  // namespace opal
