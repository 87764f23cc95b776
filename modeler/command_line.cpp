// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/command_line.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>

#include "formats/atomic_file.h"
#include "formats/command.h"
#include "formats/error.h"
#include "formats/number_option.h"
#include "formats/opal_asset.h"
#include "formats/quality.h"
#include "formats/recipe.h"
#include "formats/report.h"
#include "formats/scene.h"
#include "formats/text.h"
#include "modeler/build.h"
#include "modeler/command_percolation.h"
#include "modeler/command_section.h"
#include "modeler/info.h"

namespace opal {
namespace {

struct BuildArguments {
    std::string recipe_file;
    std::string output_file;
    std::vector<std::string> overrides;
    std::string report_file;
    std::string scene_file;
    double accepted_error_pixels = 1.0;
    std::string quality;  ///< whose pixels are taken where none are given
    int threads = 0;
    bool for_blender = false;
};

struct FileArguments {
    std::string file;
    bool json = false;
};

constexpr const char* help_footer =
    R"(Units: lengths mm (spheres and wavelengths nm, coherence length um), coefficients per mm, angles degrees, Z up.
Exit codes: 0 success, 2 bad input, 1 other failures.
Examples:
  opal-model build recipe.toml -o opal.vdb
  opal-model build recipe.toml -o opal.vdb --set grains.num_sites=2000 --set shape.size_mm=[14.0,10.0,5.0] --report report.json
  opal-model build recipe.toml -o opal.vdb --for scene.toml
  opal-model section opal.vdb --axis x -o section.png
  opal-model info opal.vdb
  opal-model check opal.vdb
  opal-model percolation recipe.toml -o percolation.csv --plot percolation.png)";

const std::vector<std::string> command_names = {"build", "info", "check", "section", "percolation"};

void say(const std::string& message) {
    fmt::print(stderr, "opal-model: {}\n", one_line(message));
    std::fflush(stderr);
}

int run_build(const BuildArguments& arguments) {
    const std::filesystem::path output(arguments.output_file);
    if (output.extension() != ".vdb") throw InputError(fmt::format("output {}: the name must end in .vdb", output.string()));
    require_writable(output);
    if (!arguments.report_file.empty()) require_writable(arguments.report_file);
    std::unique_ptr<tbb::global_control> thread_limit;
    if (arguments.threads > 0)
        thread_limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                             static_cast<std::size_t>(arguments.threads));
    catch_interrupts();
    std::optional<SceneFit> scene_fit;
    if (!arguments.scene_file.empty())
        scene_fit =
            SceneFit{read_scene(arguments.scene_file, {}), output,
                     arguments.quality.empty() ? arguments.accepted_error_pixels : quality_preset(arguments.quality).for_pixels};
    Recipe recipe = read_recipe(arguments.recipe_file, arguments.overrides);
    recipe.output.for_blender = recipe.output.for_blender || arguments.for_blender;
    BuiltOpal built = build_opal(recipe, say, scene_fit);

    throw_if_interrupted();
    say("write");
    const Stopwatch watch;
    write_opal_asset(built.asset, output, {built.output.grids, built.output.for_blender});
    built.report.stages.push_back({"write", watch.seconds()});
    if (!arguments.report_file.empty()) write_report(arguments.report_file, report_to_json(built.report, built.asset));
    fmt::print("{}file     {}, {:.2f} MB\n", report_summary(built.report, built.asset), output.string(),
               static_cast<double>(std::filesystem::file_size(output)) / 1.0e6);
    return 0;
}

int run_info(const FileArguments& arguments) {
    std::vector<std::string> notices;
    const OpalAsset asset = read_opal_asset(arguments.file, {}, notices);
    for (const std::string& notice : notices) say("notice: " + notice);
    nlohmann::json description = describe_opal(asset);
    if (arguments.json) {
        description["notices"] = notices;
        fmt::print("{}\n", description.dump(2));
    } else {
        fmt::print("{}", opal_info_text(description));
    }
    return 0;
}

int run_check(const FileArguments& arguments) {
    const AssetCheck check = check_opal_asset(arguments.file);
    for (const std::string& error : check.errors) fmt::print("error: {}\n", one_line(error));
    for (const std::string& advice : check.advice) fmt::print("advice: {}\n", one_line(advice));
    if (!check.errors.empty())
        throw InputError(
            fmt::format("{}: {} problem{} found", arguments.file, check.errors.size(), check.errors.size() == 1 ? "" : "s"));
    fmt::print("{}: is a valid opal\n", one_line(arguments.file));
    return 0;
}

std::string version_line() {
    return "opal-model " + version_report()["opal"].get<std::string>();
}

void finish_command(CLI::App& command) {
    command.set_version_flag("--version", version_line());
    command.footer(help_footer);
}

void require_known_command(int argc, char** argv) {
    if (argc < 2 || argv[1][0] == '-') return;
    if (std::find(command_names.begin(), command_names.end(), argv[1]) != command_names.end()) return;
    throw InputError(
        fmt::format("unknown command '{}'{} (commands: {})", argv[1], did_you_mean(argv[1], command_names), join(command_names)));
}

void add_build(CLI::App& app, BuildArguments& arguments) {
    CLI::App* const build = app.add_subcommand("build", "Build an opal .vdb from a recipe");
    build->add_option("RECIPE", arguments.recipe_file, "recipe file (TOML)")->required();
    build->add_option("-o,--output", arguments.output_file, "file to write, ending in .vdb")->required()->type_name("OUT.vdb");
    build->add_option("--set", arguments.overrides, "override a recipe key, e.g. grains.num_sites=1000; may be repeated")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
    CLI::Option* const scene =
        build
            ->add_option(
                "--for", arguments.scene_file,
                "model no more than this scene's picture shows: voxels from its pixels and the surface's curvature in it, no "
                "fields or grids without effect; the report says what was saved and which error is accepted")
            ->type_name("SCENE.toml");
    CLI::Option* const pixels =
        build
            ->add_option("--for-pixels", arguments.accepted_error_pixels,
                         "with --for: how far off, in pixels, the surface or a grain boundary may be at most (default 1)")
            ->check(number_between(0.01, 100.0))
            ->type_name("PIXELS");
    build
        ->add_option("--quality", arguments.quality,
                     "with --for: the pixels of a preset of opal-render: draft 10, preview 3, final 1, reference 0.5")
        ->check(CLI::IsMember(quality_names()))
        ->needs(scene)
        ->excludes(pixels);
    build->add_option("--threads", arguments.threads, "threads to use (default: all); the result is the same for any number")
        ->check(CLI::Range(1, 4096))
        ->type_name("N");
    build->add_flag("--for-blender", arguments.for_blender,
                    "add grain_id_float and orientation_rgb, twins of what Blender cannot show (the key output.for_blender)");
    build->add_option("--report", arguments.report_file, "write times, counts, versions and the resolved recipe as JSON")
        ->type_name("FILE.json");
    finish_command(*build);
}

void add_file_command(CLI::App& app, const std::string& name, const std::string& what, FileArguments& arguments, bool with_json) {
    CLI::App* const command = app.add_subcommand(name, what);
    command->add_option("FILE", arguments.file, "opal .vdb")->required();
    if (with_json) command->add_flag("--json", arguments.json, "print JSON instead");
    finish_command(*command);
}

}  // namespace

int run_opal_model(int argc, char** argv) {
    CLI::App app("Models opal: a recipe becomes a .vdb of grains for opal-render, Blender and Houdini.", "opal-model");
    app.require_subcommand(1);
    finish_command(app);
    BuildArguments build;
    FileArguments info, check;
    SectionArguments section;
    add_build(app, build);
    add_file_command(app, "info", "Say what an opal .vdb holds (sizes in mm)", info, true);
    add_file_command(app, "check", "Check an opal .vdb against the schema; exit code 2 where it is unusable", check, false);
    finish_command(*add_section(app, section));
    PercolationArguments percolation;
    finish_command(*add_percolation(app, percolation));
    require_known_command(argc, argv);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& request) {
        return app.exit(request);  // --help and --version print and succeed
    } catch (const CLI::ParseError& error) {
        throw InputError(fmt::format("{} (see opal-model --help)", error.what()));
    }
    if (app.got_subcommand("build")) return run_build(build);
    if (app.got_subcommand("info")) return run_info(info);
    if (app.got_subcommand("section")) return run_section(section);
    if (app.got_subcommand("percolation")) return run_percolation(percolation, say);
    return run_check(check);
}

}  // namespace opal
