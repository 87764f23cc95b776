// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "modeler/build_report.h"

namespace opal {

struct PercolationArguments {
    std::string recipe_file;
    std::string output_file;
    std::string plot_file;
    std::vector<std::string> overrides;
    int threads = 0;
};

/// Adds `opal-model percolation`.
CLI::App* add_percolation(CLI::App& app, PercolationArguments& arguments);

/// Writes the percolation curve of the recipe's own sites and graph, and the plot where asked for. Throws InputError for recipes
/// that cannot be built and outputs that cannot be written.
int run_percolation(const PercolationArguments& arguments, const BuildListener& listener);

}  // namespace opal
