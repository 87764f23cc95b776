// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>

#include "forked_cases.h"

namespace opal::fuzz {
namespace {

constexpr const char* footer = R"(Runs opal-render and opal-model, in processes of their own, on
  scenes   random valid scenes: each has to give a picture of finite numbers
  recipes  random recipes: each has to give a valid opal or one error
  mutated  damaged scenes, recipes, .vdb, EXR, HDR, PNG, meshes, tables, checkpoints and parts: each has to give a result or
           one error
What else happens (a crash, no end, too much memory, a value that is no number, an error in other words than ours, a file left
behind) is told with the case's number, by which it can be run again, and its files are kept.

Examples:
  opal_fuzz scenes --cases 10000
  opal_fuzz mutated --only checkpoint --first 4711 --cases 1 --keep failures)";

int fuzz_main(int argc, char** argv) {
    FuzzOptions options;
    std::string lane, only;
    CLI::App app("opal_fuzz: random and damaged input for opal-render and opal-model", "opal_fuzz");
    app.footer(footer);
    app.add_option("LANE", lane, "scenes, recipes or mutated")
        ->required()
        ->check(CLI::IsMember({"scenes", "recipes", "mutated"}));
    app.add_option("--seed", options.seed, "of the random numbers")->capture_default_str();
    app.add_option("--first", options.first, "number of the first case")->capture_default_str();
    app.add_option("--cases", options.cases, "how many")->capture_default_str();
    app.add_option("--only", only, "cases of this kind alone")->check(CLI::IsMember(kind_names()));
    app.add_option("--cpu-seconds", options.cpu_limit_s, "processor time that a case may take")->capture_default_str();
    app.add_option("--memory-gb", options.memory_limit_gb, "address space that a process may take")->capture_default_str();
    app.add_option("--keep", options.keep, "folder for the files of cases that went wrong");
    CLI11_PARSE(app, argc, argv);
    options.lane = lane == "scenes" ? Lane::scenes : lane == "recipes" ? Lane::recipes : Lane::mutated;
    if (!only.empty())
        options.only = static_cast<Kind>(std::find(kind_names().begin(), kind_names().end(), only) - kind_names().begin());
    // One thread everywhere: forked processes must not wait for threads that stayed behind.
    ::setenv("OPENIMAGEIO_THREADS", "1", 1);
    return run_forked(options).defects == 0 ? 0 : 1;
}

}  // namespace
}  // namespace opal::fuzz

int main(int argc, char** argv) {
    try {
        return opal::fuzz::fuzz_main(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "opal_fuzz: error: {}\n", error.what());
        return 1;
    }
}
