// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <string>

#include "bvh_bench.h"
#include "color_bench.h"
#include "convergence_bench.h"
#include "formats/atomic_file.h"
#include "formats/command.h"
#include "formats/error.h"
#include "formats/opal_asset.h"
#include "grains_bench.h"
#include "materials_bench.h"
#include "media_bench.h"
#include "media_checks_bench.h"
#include "modeler_bench.h"
#include "pareto/pareto_bench.h"
#include "pareto/shots_bench.h"
#include "scaling_bench.h"
#include "stability_bench.h"

namespace {

struct BenchArguments {
    std::string folder;
    bool quick = false;
    std::string scenes = "examples/media_checks";
    int samples = 16;
    int rays = 10'000'000;
    std::vector<std::string> only;
};

int run_modeler(const BenchArguments& arguments) {
    opal::initialize_openvdb();
    const std::filesystem::path folder(arguments.folder);
    const std::vector<opal::BenchRow> rows = opal::bench_modeler(folder / "work", arguments.quick);
    std::filesystem::remove_all(folder / "work");
    opal::AtomicFile file(folder / "modeler.csv");
    std::ofstream csv(file.temporary_path());
    csv << "what,value,unit\n";
    for (const opal::BenchRow& row : rows) csv << fmt::format("\"{}\",{:.6g},{}\n", row.what, row.value, row.unit);
    csv.close();
    if (!csv) throw opal::SystemError(fmt::format("{}: writing failed", (folder / "modeler.csv").string()));
    file.commit();
    return 0;
}

int run_media(const std::filesystem::path& folder) {
    opal::initialize_openvdb();
    std::filesystem::create_directories(folder);
    const std::vector<opal::MediaBenchRow> rows = opal::bench_media();
    opal::AtomicFile file(folder / "media.csv");
    std::ofstream csv(file.temporary_path());
    csv << "medium,field,contrast,method,cells,fitted,ns_per_flight,variance,ns_times_variance\n";
    for (const opal::MediaBenchRow& row : rows)
        csv << fmt::format("{},{},{},{},{},{},{:.4g},{:.4g},{:.4g}\n", row.medium, row.field, row.contrast, row.method, row.cells,
                           row.fitted ? 1 : 0, row.ns_per_flight, row.variance, row.ns_per_flight * row.variance);
    csv.close();
    if (!csv) throw opal::SystemError(fmt::format("{}: writing failed", (folder / "media.csv").string()));
    file.commit();
    return 0;
}

int run_grains(const std::filesystem::path& folder, bool quick) {
    opal::initialize_openvdb();
    std::filesystem::create_directories(folder);
    const std::vector<opal::GrainsBenchRow> rows = opal::bench_grains(quick);
    opal::AtomicFile file(folder / "grains.csv");
    std::ofstream csv(file.temporary_path());
    csv << "weights,sites,method,voxels_across,ns_per_grain,bytes,build_s,crossings,missed,spurious,wrong_length,mean_error_um,"
           "largest_error_um\n";
    for (const opal::GrainsBenchRow& row : rows)
        csv << fmt::format("{},{},{},{},{:.4g},{},{:.4g},{},{},{},{:.4g},{:.4g},{:.4g}\n", row.weights, row.sites, row.method,
                           row.voxels_across, row.ns_per_grain, row.bytes, row.build_s, row.crossings, row.missed, row.spurious,
                           row.wrong_length, row.mean_error_um, row.largest_error_um);
    csv.close();
    if (!csv) throw opal::SystemError(fmt::format("{}: writing failed", (folder / "grains.csv").string()));
    file.commit();
    return 0;
}

int run_bench(int argc, char** argv) {
    CLI::App app("Measures opal's programs: speed and memory as ratios within one run.", "opal-bench");
    app.require_subcommand(1);
    BenchArguments arguments;
    CLI::App* const modeler = app.add_subcommand("modeler", "opal-model: labelling, builds, memory (some minutes)");
    modeler->add_option("-o,--output", arguments.folder, "folder for modeler.csv")->required()->type_name("DIR");
    modeler->add_flag("--quick", arguments.quick, "an eighth of the voxels (about a minute)");
    CLI::App* const bvh =
        app.add_subcommand("bvh", "rays against triangles and patches: devices' hierarchy and Embree (a minute)");
    bvh->add_option("-o,--output", arguments.folder, "folder for bvh.csv")->required()->type_name("DIR");
    bvh->add_option("--rays", arguments.rays, "over all scenes")->check(CLI::Range(1000, 1 << 30))->capture_default_str();
    CLI::App* const stability = app.add_subcommand("stability", "where each method degrades, and how (some minutes)");
    stability->add_option("-o,--output", arguments.folder, "folder for stability.csv and its chart")
        ->required()
        ->type_name("DIR");
    stability->add_flag("--quick", arguments.quick, "fewer samples and places (under a minute)");
    CLI::App* const scaling = app.add_subcommand("scaling", "cost against size, with fitted exponents (some minutes)");
    scaling->add_option("-o,--output", arguments.folder, "folder for the .csv files and the chart")->required()->type_name("DIR");
    scaling->add_flag("--quick", arguments.quick, "small sizes alone (under a minute)");
    CLI::App* const media = app.add_subcommand("media", "flights through fields: majorants and estimators (about a minute)");
    media->add_option("-o,--output", arguments.folder, "folder for media.csv")->required()->type_name("DIR");
    CLI::App* const color = app.add_subcommand("color", "ways from colours to spectra: round trips, products (some seconds)");
    color->add_option("-o,--output", arguments.folder, "folder for the .csv files")->required()->type_name("DIR");
    CLI::App* const grains = app.add_subcommand("grains", "finding the grains along rays: speed, memory, errors (some minutes)");
    grains->add_option("-o,--output", arguments.folder, "folder for grains.csv")->required()->type_name("DIR");
    grains->add_flag("--quick", arguments.quick, "1,000 sites alone");
    CLI::App* const materials = app.add_subcommand("materials", "metals' reflectance; what turns once at rough surfaces");
    materials->add_option("-o,--output", arguments.folder, "folder for the .csv files")->required()->type_name("DIR");
    CLI::App* const checks = app.add_subcommand(
        "media-checks", "examples/media_checks: speed and variance, to be run beside other renderers (some minutes)");
    checks->add_option("-o,--output", arguments.folder, "folder for media_checks.csv and disc.exr")->required()->type_name("DIR");
    checks->add_option("--scenes", arguments.scenes, "folder of the scenes")->type_name("DIR")->capture_default_str();
    checks->add_option("--spp", arguments.samples, "samples per pixel of each of two renders")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    CLI::App* const convergence =
        app.add_subcommand("convergence", "samples and time to equal error: wavelengths, samplers, guiding (some ten minutes)");
    convergence->add_option("-o,--output", arguments.folder, "folder for the .csv files")->required()->type_name("DIR");
    convergence->add_flag("--quick", arguments.quick, "fewer pixels and samples (about a minute)");
    CLI::App* const pareto = app.add_subcommand("pareto", "speed against accuracy: every choice on four opals (most of an hour)");
    pareto->add_option("-o,--output", arguments.folder, "folder for pareto.csv")->required()->type_name("DIR");
    pareto->add_flag("--quick", arguments.quick, "two opals, fewer values, coarser statistics (some minutes)");
    pareto->add_option("--only", arguments.only, "a choice or a scene to measure, as the table names it; repeatable")
        ->type_name("NAME");
    CLI::App* const shots =
        app.add_subcommand("shots", "one opal from afar, as a product, close up: the whole model against --for");
    shots->add_option("-o,--output", arguments.folder, "folder for shots.csv")->required()->type_name("DIR");
    shots->add_flag("--quick", arguments.quick, "an eighth of the samples");
    shots->add_option("--only", arguments.only, "a shot: wide, product or macro; repeatable")->type_name("NAME");
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& request) {
        return app.exit(request);
    } catch (const CLI::ParseError& error) {
        throw opal::InputError(fmt::format("{} (see opal-bench --help)", error.what()));
    }
    if (color->parsed()) {
        opal::bench_color(arguments.folder);
        return 0;
    }
    if (stability->parsed()) {
        opal::bench_stability(arguments.folder, arguments.quick);
        return 0;
    }
    if (scaling->parsed()) {
        opal::bench_scaling(arguments.folder, arguments.quick);
        return 0;
    }
    if (grains->parsed()) return run_grains(arguments.folder, arguments.quick);
    if (convergence->parsed()) {
        opal::bench_convergence(arguments.folder, arguments.quick);
        return 0;
    }
    if (pareto->parsed()) {
        opal::bench_pareto(arguments.folder, arguments.quick, arguments.only);
        return 0;
    }
    if (shots->parsed()) {
        opal::bench_shots(arguments.folder, arguments.quick, arguments.only);
        return 0;
    }
    if (bvh->parsed()) {
        opal::bench_bvh(arguments.folder, std::uint64_t(arguments.rays));
        return 0;
    }
    if (media->parsed()) return run_media(arguments.folder);
    if (materials->parsed()) {
        opal::bench_materials(arguments.folder);
        return 0;
    }
    if (checks->parsed()) {
        opal::initialize_openvdb();
        opal::bench_media_checks(arguments.scenes, arguments.folder, arguments.samples);
        return 0;
    }
    return run_modeler(arguments);
}

}  // namespace

int main(int argc, char** argv) {
    return opal::run_command("opal-bench", [&] { return run_bench(argc, argv); });
}
