// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/build_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/command.h"
#include "formats/report.h"
#include "formats/units.h"
#include "modeler/cgal_version.h"

namespace opal {
namespace {

std::string describe_distributions(const GrainStatistics& statistics) {
    std::string text;
    if (statistics.has_volumes)
        text += fmt::format("sizes    {:.3g} to {:.3g} mm across, half of the grains below {:.3g} mm{}\n",
                            statistics.diameter_mm.min, statistics.diameter_mm.max, statistics.diameter_mm.median,
                            statistics.grains_without_voxels == 0
                                ? std::string()
                                : fmt::format("; {} grains have no voxel", statistics.grains_without_voxels));
    if (statistics.neighbouring_grains > 0)
        text += fmt::format("lattices {:.1f} degrees apart on average between {} pairs of neighbours (random: 40.7)\n",
                            statistics.misorientation_deg.mean, statistics.neighbouring_grains);
    return text;
}

/// Of the grids in memory, points aside.
std::uint64_t grid_memory_bytes(const OpalAsset& asset) {
    std::uint64_t sum = asset.grain_id ? asset.grain_id->memUsage() : 0;
    for (const auto& grid : {asset.shape, asset.weight, asset.sigma_a_scale, asset.sigma_s_rayleigh_400nm, asset.sigma_s_mie})
        if (grid) sum += grid->memUsage();
    return sum;
}

}  // namespace

double BuildReport::total_seconds() const {
    double sum = 0.0;
    for (const StageTime& time : stages) sum += time.seconds;
    return sum;
}

double mean_grain_diameter_mm(const OpalAsset& asset) {
    if (asset.num_grains() == 0 || !asset.grain_id) return 0.0;
    const double volume_mm3 = static_cast<double>(asset.grain_id->activeVoxelCount()) * asset.grain_id->voxelSize().product();
    return std::cbrt(6.0 * volume_mm3 / (units::pi * static_cast<double>(asset.num_grains())));
}

namespace {

/// Without voxels to count, from the volume that was estimated while sites were sampled.
double mean_diameter_mm(const BuildReport& report, const OpalAsset& asset) {
    if (asset.grain_id) return mean_grain_diameter_mm(asset);
    return std::cbrt(6.0 * report.shape_volume_mm3 / (units::pi * static_cast<double>(asset.num_grains())));
}

}  // namespace

nlohmann::json report_to_json(const BuildReport& report, const OpalAsset& asset) {
    nlohmann::json seconds = nlohmann::json::object();
    for (const StageTime& time : report.stages) seconds[time.stage] = time.seconds;
    seconds["total"] = report.total_seconds();

    nlohmann::json json;
    json["seconds"] = seconds;
    json["peak_memory_bytes"] = peak_memory_bytes();
    json["grid_memory_bytes"] = grid_memory_bytes(asset);
    json["counts"] = {{"sites", asset.sites.size()},
                      {"hidden_sites", report.hidden_sites},
                      {"bonds", report.bonds},
                      {"kept_bonds", report.kept_bonds},
                      {"mean_degree", report.mean_degree},
                      {"grains", asset.num_grains()},
                      {"voxels", report.voxels},
                      {"voxels_in_box", report.voxels_in_box},
                      {"leaves", report.leaves},
                      {"tiles", report.tiles},
                      {"largest_grain_fraction", report.largest_grain_fraction}};
    json["shape_volume_mm3"] = report.shape_volume_mm3;
    json["voxel_size_mm"] = asset.grain_id ? nlohmann::json(asset.grain_id->voxelSize().x()) : nlohmann::json();
    json["mean_grain_diameter_mm"] = mean_diameter_mm(report, asset);
    json["shortest_site_distance_mm"] = report.shortest_site_distance_mm;
    json["relative_radius"] = report.relative_radius;
    json["weight_scale"] = report.weight_scale;
    json["bond_probability"] = report.bond_probability;
    json["percolation_threshold"] =
        report.percolation_threshold ? nlohmann::json(*report.percolation_threshold) : nlohmann::json();
    if (report.scene_needs) json["for_scene"] = scene_needs_to_json(*report.scene_needs);
    json["grain_statistics"] = grain_statistics_to_json(report.grain_statistics);
    json["warnings"] = report.warnings;
    json["versions"] = version_report({{"cgal", cgal_version()}});
    json["seed"] = asset.seed;
    json["recipe"] = asset.recipe_toml;
    return json;
}

std::string report_summary(const BuildReport& report, const OpalAsset& asset) {
    std::string text = fmt::format(
        "grains   {} from {} sites ({} hidden), {:.2f} mm across on average, largest {:.1f} % of the sites\n", asset.num_grains(),
        asset.sites.size(), report.hidden_sites, mean_diameter_mm(report, asset), 100.0 * report.largest_grain_fraction);
    text += describe_distributions(report.grain_statistics);
    text +=
        fmt::format("bonds    {} of {} kept ({:.2f} neighbours per site)\n", report.kept_bonds, report.bonds, report.mean_degree);
    if (asset.grain_id)
        text += fmt::format(
            "voxels   {} of {:.4g} mm inside the shape ({:.0f} % of its box), in {} leaves and {} tiles\n", report.voxels,
            asset.grain_id->voxelSize().x(),
            100.0 * static_cast<double>(report.voxels) / static_cast<double>(std::max<std::uint64_t>(1, report.voxels_in_box)),
            report.leaves, report.tiles);
    else
        text += "voxels   no labels: grains are in the sites alone\n";
    if (report.scene_needs) text += scene_needs_summary(*report.scene_needs);
    text += fmt::format("time     {}, at most {:.0f} MB of memory\n", format_duration(report.total_seconds()),
                        static_cast<double>(peak_memory_bytes()) / 1.0e6);
    return text;
}

}  // namespace opal
