// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/grain_statistics.h"

#include <openvdb/tree/LeafManager.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>

#include "formats/units.h"
#include "modeler/misorientation.h"

namespace opal {
namespace {

constexpr int diameter_bins = 20;
constexpr double misorientation_bin_deg = 2.0;
constexpr int misorientation_bins = 32;  // the largest is 62.8 degrees

Spread spread_of(std::vector<double> values) {
    if (values.empty()) return {};
    tbb::parallel_sort(values.begin(), values.end());
    const auto count = static_cast<double>(values.size());
    Spread spread;
    for (const double value : values) spread.mean += value / count;
    for (const double value : values) spread.std += (value - spread.mean) * (value - spread.mean) / count;
    spread.std = std::sqrt(spread.std);
    spread.min = values.front();
    spread.median = 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
    spread.max = values.back();
    return spread;
}

/// Values beyond the ends go to the first and last bin.
Histogram count_in_bins(const std::vector<double>& values, std::vector<double> edge) {
    Histogram histogram{std::move(edge), {}};
    histogram.count.assign(histogram.edge.size() - 1, 0);
    for (const double value : values) {
        const auto above = std::upper_bound(histogram.edge.begin(), histogram.edge.end(), value) - histogram.edge.begin();
        ++histogram.count[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 1, 0, std::ssize(histogram.count) - 1))];
    }
    return histogram;
}

void describe_volumes(const OpalAsset& asset, GrainStatistics& statistics) {
    if (!asset.grain_id) return;
    statistics.has_volumes = true;
    const double voxel_volume_mm3 = asset.grain_id->voxelSize().product();
    std::vector<double> volumes_mm3, diameters_mm;
    for (const std::uint64_t voxels : voxels_per_grain(*asset.grain_id, asset.num_grains())) {
        if (voxels == 0) {
            ++statistics.grains_without_voxels;
            continue;
        }
        volumes_mm3.push_back(static_cast<double>(voxels) * voxel_volume_mm3);
        diameters_mm.push_back(std::cbrt(6.0 / units::pi * volumes_mm3.back()));
    }
    if (volumes_mm3.empty()) return;
    statistics.volume_mm3 = spread_of(std::move(volumes_mm3));
    statistics.diameter_mm = spread_of(diameters_mm);
    const auto [min, max] = std::pair(statistics.diameter_mm.min, statistics.diameter_mm.max);
    std::vector<double> edge = {min};
    // Grains of one size share a single bin.
    for (int n = 1; n < diameter_bins && max > min; ++n) edge.push_back(min * std::pow(max / min, double(n) / diameter_bins));
    edge.push_back(max);
    statistics.diameter_histogram = count_in_bins(diameters_mm, std::move(edge));
}

void describe_sites_per_grain(const OpalAsset& asset, GrainStatistics& statistics) {
    std::vector<double> sites(asset.num_grains(), 0.0);
    for (const Site& site : asset.sites)
        if (site.grain > 0) sites[static_cast<std::size_t>(site.grain) - 1] += 1.0;
    statistics.sites_per_grain = spread_of(sites);
    std::vector<double> edge = {1.0};
    while (edge.back() <= statistics.sites_per_grain.max) edge.push_back(2.0 * edge.back());
    if (edge.size() > 1) statistics.sites_histogram = count_in_bins(sites, std::move(edge));
}

/// Pairs of grains, the lower first, with a bond between them.
NeighbourGraph neighbouring_grains(const OpalAsset& asset, const NeighbourGraph& graph) {
    NeighbourGraph grains;
    for (const NeighbourPair& pair : graph) {
        const std::int32_t a = asset.sites[static_cast<std::size_t>(pair.first)].grain;
        const std::int32_t b = asset.sites[static_cast<std::size_t>(pair.second)].grain;
        if (a != b) grains.push_back({std::min(a, b), std::max(a, b)});
    }
    tbb::parallel_sort(grains.begin(), grains.end());
    grains.erase(std::unique(grains.begin(), grains.end()), grains.end());
    return grains;
}

void describe_misorientations(const OpalAsset& asset, const NeighbourGraph& graph, GrainStatistics& statistics) {
    const NeighbourGraph pairs = neighbouring_grains(asset, graph);
    std::vector<double> angles_deg(pairs.size());
    tbb::parallel_for(std::size_t(0), pairs.size(), [&](std::size_t n) {
        const auto orientation = [&](std::int32_t grain) {
            return asset.grain_orientations[static_cast<std::size_t>(grain) - 1];
        };
        angles_deg[n] = units::deg_from_rad(misorientation_angle_rad(orientation(pairs[n].first), orientation(pairs[n].second)));
    });
    statistics.neighbouring_grains = pairs.size();
    statistics.misorientation_deg = spread_of(angles_deg);
    std::vector<double> edge;
    for (int n = 0; n <= misorientation_bins; ++n) edge.push_back(misorientation_bin_deg * n);
    for (int n = 0; n < misorientation_bins; ++n) {
        const double from_rad = units::rad_from_deg(edge[std::size_t(n)]), to_rad = units::rad_from_deg(edge[std::size_t(n) + 1]);
        statistics.misorientation_expected.push_back(mackenzie_distribution(to_rad) - mackenzie_distribution(from_rad));
    }
    statistics.misorientation_histogram = count_in_bins(angles_deg, std::move(edge));
}

nlohmann::json to_json(const Spread& spread) {
    return {{"mean", spread.mean}, {"std", spread.std}, {"min", spread.min}, {"median", spread.median}, {"max", spread.max}};
}

nlohmann::json to_json(const Histogram& histogram) {
    return {{"edges", histogram.edge}, {"counts", histogram.count}};
}

}  // namespace

std::vector<std::uint64_t> voxels_per_grain(const openvdb::Int32Grid& grain_id, std::size_t num_grains) {
    using Counts = std::vector<std::uint64_t>;
    const Counts none(num_grains + 1, 0);
    tbb::enumerable_thread_specific<Counts> counts_of_threads([&] { return none; });
    openvdb::tree::LeafManager<const openvdb::Int32Tree> leaves(grain_id.tree());
    leaves.foreach ([&](const openvdb::Int32Tree::LeafNodeType& leaf, std::size_t) {
        Counts& counts = counts_of_threads.local();
        for (auto value = leaf.cbeginValueOn(); value; ++value) ++counts[static_cast<std::size_t>(*value)];
    });
    Counts sums = none;
    for (const Counts& counts : counts_of_threads)
        for (std::size_t n = 0; n < sums.size(); ++n) sums[n] += counts[n];
    auto tile = grain_id.tree().cbeginValueOn();
    tile.setMaxDepth(openvdb::Int32Tree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) sums[static_cast<std::size_t>(*tile)] += tile.getVoxelCount();
    return {sums.begin() + 1, sums.end()};
}

GrainStatistics grain_statistics(const OpalAsset& asset, const NeighbourGraph& graph) {
    GrainStatistics statistics;
    describe_volumes(asset, statistics);
    describe_sites_per_grain(asset, statistics);
    describe_misorientations(asset, graph, statistics);
    return statistics;
}

nlohmann::json grain_statistics_to_json(const GrainStatistics& statistics) {
    nlohmann::json json;
    if (statistics.has_volumes) {
        json["grains_without_voxels"] = statistics.grains_without_voxels;
        json["volume_mm3"] = to_json(statistics.volume_mm3);
        json["diameter_mm"] = to_json(statistics.diameter_mm);
        json["diameter_mm"]["histogram"] = to_json(statistics.diameter_histogram);
    }
    json["sites_per_grain"] = to_json(statistics.sites_per_grain);
    json["sites_per_grain"]["histogram"] = to_json(statistics.sites_histogram);
    json["misorientation_deg"] = to_json(statistics.misorientation_deg);
    json["misorientation_deg"]["pairs"] = statistics.neighbouring_grains;
    json["misorientation_deg"]["histogram"] = to_json(statistics.misorientation_histogram);
    json["misorientation_deg"]["histogram"]["mackenzie"] = statistics.misorientation_expected;
    return json;
}

}  // namespace opal
