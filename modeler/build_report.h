// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "formats/opal_asset.h"
#include "modeler/grain_statistics.h"
#include "modeler/scene_needs.h"

namespace opal {

/// Told the name of each stage as it begins, and warnings.
using BuildListener = std::function<void(const std::string& message)>;

struct StageTime {
    std::string stage;
    double seconds = 0.0;
};

/// What happened while an opal was built: for people, for scripts and for the bench.
struct BuildReport {
    std::vector<StageTime> stages;
    std::vector<std::string> warnings;

    double shape_volume_mm3 = 0.0;
    double shortest_site_distance_mm = 0.0;
    double relative_radius = 0.0;  ///< shortest distance over that of the densest packing
    double weight_scale = 1.0;     ///< by which all weights were multiplied to limit them
    std::size_t hidden_sites = 0;
    std::size_t bonds = 0;
    std::size_t kept_bonds = 0;
    double mean_degree = 0.0;  ///< neighbours per visible site
    double bond_probability = 0.0;
    double largest_grain_fraction = 0.0;          ///< of the visible sites
    std::optional<double> percolation_threshold;  ///< estimate for this graph

    std::uint64_t voxels = 0;         ///< inside the shape
    std::uint64_t voxels_in_box = 0;  ///< of the box around them
    std::uint64_t leaves = 0;         ///< of grain_id
    std::uint64_t tiles = 0;          ///< active ones of grain_id

    std::optional<SceneNeeds> scene_needs;  ///< where the opal was modelled for a scene

    GrainStatistics grain_statistics;

    double total_seconds() const;
};

/// The report as JSON: seconds per stage, peak memory, counts, versions, seed, resolved recipe.
nlohmann::json report_to_json(const BuildReport& report, const OpalAsset& asset);

/// A few lines for a person.
std::string report_summary(const BuildReport& report, const OpalAsset& asset);

/// Diameter of a ball of the mean volume of a grain, in mm; 0 for an opal without grains or without voxels.
double mean_grain_diameter_mm(const OpalAsset& asset);

}  // namespace opal
