// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler_bench.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "formats/command.h"
#include "formats/error.h"
#include "formats/opal_asset.h"
#include "formats/recipe.h"
#include "kd_tree_labels.h"
#include "modeler/labelling.h"
#include "modeler/shape.h"
#include "modeler/sites.h"
#include "modeler/weights.h"

namespace opal {
namespace {

constexpr int repetitions = 3;
const std::string recipe_text = "[shape]\nkind = \"ellipsoid\"\nsize_mm = 20\n[grains]\nnum_sites = 27000\nresolution = 512\n";

class ModelerBench {
  public:
    ModelerBench(std::filesystem::path folder, bool quick) : folder_(std::move(folder)), resolution_(quick ? 256 : 512) {
        std::filesystem::create_directories(folder_);
        std::ofstream(folder_ / "recipe.toml") << recipe_text;
    }

    std::vector<BenchRow> run() {
        label_against_kd_tree();
        build_many_sites();
        grow_resolution();
        use_two_threads();
        weigh_memory();
        write_sites_alone();
        return std::move(rows_);
    }

  private:
    void add(const std::string& what, double value, const std::string& unit) {
        rows_.push_back({what, value, unit});
        fmt::print("{:<72} {:>10.4g} {}\n", what, value, unit);
        std::fflush(stdout);
    }

    void label_against_kd_tree() {
        const Recipe recipe = parse_recipe(recipe_text, "recipe.toml", {fmt::format("grains.resolution={}", resolution_)});
        const auto shape = make_shape(recipe.shape);
        const SiteSet set = sample_sites(*shape, recipe.grains);
        const std::vector<Site> sites = weigh_sites(set, recipe.grains, *shape).sites;
        std::vector<std::int32_t> label_of_site(sites.size());
        std::iota(label_of_site.begin(), label_of_site.end(), 1);
        const auto level_set = shape->level_set(shape->bounds_mm().extents().x() / resolution_);
        openvdb::Int32Grid::Ptr labels;
        double seconds = std::numeric_limits<double>::infinity();
        for (int n = 0; n < repetitions; ++n) {
            const Stopwatch watch;
            labels = label_voxels(sites, label_of_site, *level_set);
            seconds = std::min(seconds, watch.seconds());
        }
        const double per_voxel_ns = 1.0e9 * seconds / static_cast<double>(labels->activeVoxelCount());
        add(fmt::format("labelling, {}^3, 27,000 sites, additive: per voxel inside", resolution_), per_voxel_ns, "ns");
        for (const bool weights_count : {true, false}) {
            const KdTreeLabels peer = label_by_kd_tree(sites, label_of_site, *labels, 16, weights_count);
            const double peer_ns = 1.0e9 * peer.seconds / static_cast<double>(peer.voxels);
            const std::string name =
                weights_count ? "k-d tree, exact with weights" : "k-d tree, one nearest site, weights disregarded";
            add(fmt::format("{}: per voxel (every 16th leaf)", name), peer_ns, "ns");
            add(fmt::format("{}: labels that differ", name), static_cast<double>(peer.differences), "voxels");
            add(fmt::format("{}: times as long as labelling", name), peer_ns / per_voxel_ns, "x");
        }
    }

    /// Builds in a process of its own, so that peak memory is its own; the report of the fastest of several runs.
    nlohmann::json build(const std::string& settings, int runs = 1) const {
        nlohmann::json best;
        for (int n = 0; n < runs; ++n) {
            const std::string command = fmt::format("'{}' build '{}' -o '{}' --report '{}' {} >/dev/null 2>&1", OPAL_MODEL,
                                                    (folder_ / "recipe.toml").string(), (folder_ / "opal.vdb").string(),
                                                    (folder_ / "report.json").string(), settings);
            if (std::system(command.c_str()) != 0) throw SystemError("a build failed: " + command);
            std::ifstream file(folder_ / "report.json");
            nlohmann::json report = nlohmann::json::parse(file);
            if (best.is_null() || total(report) < total(best)) best = std::move(report);
        }
        return best;
    }

    static double total(const nlohmann::json& report) { return report["seconds"]["total"].get<double>(); }
    static double stage(const nlohmann::json& report, const char* name) { return report["seconds"][name].get<double>(); }
    static double peak_mb(const nlohmann::json& report) { return report["peak_memory_bytes"].get<double>() / 1.0e6; }
    static double grids_mb(const nlohmann::json& report) { return report["grid_memory_bytes"].get<double>() / 1.0e6; }
    std::string at_resolution(int resolution, int sites) const {
        return fmt::format("--set grains.resolution={} --set grains.num_sites={}", resolution, sites);
    }

    void build_many_sites() {
        const nlohmann::json few = build(at_resolution(resolution_, 27'000), repetitions);
        const nlohmann::json many = build(at_resolution(resolution_, 262'144));
        add(fmt::format("whole build with its file, {}^3, 27,000 sites", resolution_), total(few), "s");
        for (const char* name : {"sites", "neighbour_graph", "level_set", "labelling", "write"})
            add(fmt::format("  of that {}", name), stage(few, name), "s");
        add("whole build with its file, 262,144 sites", total(many), "s");
        for (const char* name : {"sites", "neighbour_graph", "level_set", "labelling", "write"})
            add(fmt::format("  of that {}", name), stage(many, name), "s");
        add("262,144 sites against 27,000", total(many) / total(few), "x");
    }

    void grow_resolution() {
        std::vector<double> seconds;
        for (const int factor : {1, 2, 4}) {
            const int resolution = factor * resolution_ / 2;
            const nlohmann::json report = build(at_resolution(resolution, 1000), 2);
            seconds.push_back(total(report));
            add(fmt::format("whole build, 1,000 sites, {}^3", resolution), total(report), "s");
        }
        add("exponent of the time over the resolution (end to end)", std::log2(seconds[2] / seconds[0]) / 2.0, "");
        add("exponent of the time over the resolution (last doubling)", std::log2(seconds[2] / seconds[1]), "");
    }

    void use_two_threads() {
        const std::string settings = at_resolution(resolution_, 27'000);
        double one = std::numeric_limits<double>::infinity(), two = one;
        for (int n = 0; n < repetitions; ++n) {
            one = std::min(one, stage(build(settings + " --threads 1"), "labelling"));
            two = std::min(two, stage(build(settings + " --threads 2"), "labelling"));
        }
        add("labelling, 27,000 sites: two threads against one", one / two, "x");
    }

    void weigh_memory() {
        for (const int resolution : {resolution_, 2 * resolution_}) {
            const nlohmann::json report = build(at_resolution(resolution, 27'000));
            add(fmt::format("peak memory, {}^3, 27,000 sites", resolution), peak_mb(report), "MB");
            add("  against the grids written, in memory", peak_mb(report) / grids_mb(report), "x");
        }
    }

    void write_sites_alone() {
        const nlohmann::json report = build("--set 'output.grids=[\"sites\"]' --set grains.voxel_size_mm=0.0001", repetitions);
        add("sites alone, 27,000, at 200,000^3: time", total(report), "s");
        add("sites alone: peak memory", peak_mb(report), "MB");
    }

    std::filesystem::path folder_;
    int resolution_;
    std::vector<BenchRow> rows_;
};

}  // namespace

std::vector<BenchRow> bench_modeler(const std::filesystem::path& folder, bool quick) {
    return ModelerBench(folder, quick).run();
}

}  // namespace opal
