// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/command_percolation.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <filesystem>
#include <memory>

#include "formats/atomic_file.h"
#include "formats/command.h"
#include "formats/error.h"
#include "formats/recipe.h"
#include "formats/recipe_names.h"
#include "formats/report.h"
#include "modeler/grain_growth.h"
#include "modeler/percolation.h"
#include "modeler/percolation_plot.h"
#include "modeler/site_network.h"

namespace opal {
namespace {

struct Percolation {
    SiteNetwork network;
    Sintering sintering;  ///< what the recipe itself makes of the sites
    PercolationCurve curve;
};

Percolation percolate(const Recipe& recipe, StageRunner& stages) {
    Percolation result;
    const auto shape = stages.run("shape", [&] { return make_shape(recipe.shape); });
    result.network = make_site_network(recipe, *shape, stages);
    const std::vector<double> weights = bond_weights(recipe, result.network, orientations_to_sinter_by(recipe, result.network));
    result.sintering = stages.run("sintering", [&] { return sinter_network(recipe, result.network, weights); });
    result.curve = stages.run("percolation", [&] {
        return percolation_curve(BondOrder(result.network.graph, weights, recipe.grains.seed), result.network.hidden);
    });
    return result;
}

std::string graph_name(const Recipe& recipe) {
    return recipe_names::name(recipe_names::graphs, recipe.grains.sintering.graph);
}

std::vector<std::string> notes_on(const Recipe& recipe, const Percolation& result) {
    const SinteringRecipe& sintering = recipe.grains.sintering;
    const std::string& preference = recipe_names::name(recipe_names::preferences, sintering.preference);
    return {"opal-model " + version_report()["opal"].get<std::string>() + ", bond percolation of grains, seed " +
                std::to_string(recipe.grains.seed),
            fmt::format("graph {}, preference {}, sites {}, hidden {}, bonds {}, mean degree {:.4f}", graph_name(recipe),
                        preference, result.network.sites.size(), result.network.sites.size() - result.network.num_visible(),
                        result.network.graph.size(), result.network.mean_degree()),
            fmt::format("recipe: p {:.6g}, grains {}, largest fraction {:.4g}", result.sintering.probability,
                        result.sintering.num_grains, result.sintering.largest_grain_fraction),
            sintering.preference == BondPreference::none
                ? "one sweep over the bonds, averaged over the binomial number of bonds kept at p"
                : "one sweep over the weighted bonds, as they are kept at p"};
}

std::string summary(const Percolation& result) {
    return fmt::format(
        "recipe     p {:.4g}: {} grains of {} sites, the largest {:.1f} %\nthreshold  {}\n", result.sintering.probability,
        result.sintering.num_grains, result.network.num_visible(), 100.0 * result.sintering.largest_grain_fraction,
        result.curve.threshold ? fmt::format("p about {:.4g}", *result.curve.threshold) : "none: no two sites touch");
}

}  // namespace

CLI::App* add_percolation(CLI::App& app, PercolationArguments& arguments) {
    CLI::App* const command = app.add_subcommand("percolation", "Write how a recipe's sites merge into grains as p grows");
    command->add_option("RECIPE", arguments.recipe_file, "recipe file (TOML)")->required();
    command->add_option("-o,--output", arguments.output_file, "table to write, ending in .csv")->required()->type_name("OUT.csv");
    command->add_option("--plot", arguments.plot_file, "draw N(p) and largest(p) as well, ending in .png")->type_name("OUT.png");
    command->add_option("--set", arguments.overrides, "override a recipe key, e.g. grains.num_sites=1000; may be repeated")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
    command->add_option("--threads", arguments.threads, "threads to use (default: all); the result is the same for any number")
        ->check(CLI::Range(1, 4096))
        ->type_name("N");
    return command;
}

int run_percolation(const PercolationArguments& arguments, const BuildListener& listener) {
    const std::filesystem::path output(arguments.output_file), plot(arguments.plot_file);
    if (output.extension() != ".csv") throw InputError(fmt::format("output {}: the name must end in .csv", output.string()));
    if (!plot.empty() && plot.extension() != ".png")
        throw InputError(fmt::format("--plot {}: the name must end in .png", plot.string()));
    require_writable(output);
    if (!plot.empty()) require_writable(plot);
    std::unique_ptr<tbb::global_control> thread_limit;
    if (arguments.threads > 0)
        thread_limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                             static_cast<std::size_t>(arguments.threads));
    catch_interrupts();
    const Recipe recipe = read_recipe(arguments.recipe_file, arguments.overrides);
    initialize_openvdb();
    BuildReport report;
    StageRunner stages(report, listener);
    const Percolation result = percolate(recipe, stages);
    throw_if_interrupted();
    write_text_file(output, percolation_csv(result.curve, result.network.num_visible(), notes_on(recipe, result)));
    if (!plot.empty())
        write_png(plot, draw_percolation_plot(
                            {result.curve, result.network.num_visible(),
                             fmt::format("Grains of {} sites, {} graph, {:.2f} neighbours each", result.network.num_visible(),
                                         graph_name(recipe), result.network.mean_degree()),
                             result.sintering.probability}));
    fmt::print("{}", summary(result));
    return 0;
}

}  // namespace opal
