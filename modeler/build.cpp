// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/command.h"
#include "formats/error.h"
#include "formats/report.h"
#include "modeler/labelling.h"
#include "modeler/level_set.h"
#include "modeler/neighbour_graph.h"
#include "modeler/shape.h"
#include "modeler/sintering.h"
#include "modeler/sites.h"
#include "modeler/weights.h"

namespace opal {
namespace {

constexpr double max_voxels = 0x1p33;
/// OpenVDB counts voxels in 32 bits along an axis; far below that, doubles still tell neighbouring voxels apart.
constexpr double max_voxels_per_axis = 0x1p20;
/// OpenVDB takes transforms with smaller voxels for singular.
constexpr double min_voxel_size_mm = 1.5e-5;
/// A grain with more than this part of the sites deserves a warning, in an opal of more than so many sites.
constexpr double large_grain_fraction = 0.2;
constexpr std::size_t few_sites = 50;

/// Runs stages, timing and announcing them.
class StageRunner {
  public:
    StageRunner(BuildReport& report, const BuildListener& listener) : report_(report), listener_(listener) {}

    template <typename Work>
    auto run(const std::string& stage, const Work& work) {
        throw_if_interrupted();
        listener_(stage);
        const Stopwatch watch;
        auto result = work();
        report_.stages.push_back({stage, watch.seconds()});
        return result;
    }

    void warn(const std::string& warning) {
        report_.warnings.push_back(warning);
        listener_("warning: " + warning);
    }

  private:
    BuildReport& report_;
    const BuildListener& listener_;
};

double resolve_voxel_size_mm(const Recipe& recipe, const openvdb::BBoxd& bounds_mm) {
    const openvdb::Vec3d extents_mm = bounds_mm.extents();
    const double longest_mm = std::max({extents_mm.x(), extents_mm.y(), extents_mm.z()});
    const double voxel_size_mm = recipe.resolution > 0 ? longest_mm / recipe.resolution : recipe.grains.voxel_size_mm;
    if (!(voxel_size_mm >= min_voxel_size_mm))
        throw InputError(fmt::format("grains: voxels of {:.3g} mm are smaller than a .vdb can hold ({:.3g} mm)", voxel_size_mm,
                                     min_voxel_size_mm));
    double voxels = 1.0;
    for (int axis = 0; axis < 3; ++axis) voxels *= std::ceil(extents_mm[axis] / voxel_size_mm);
    const double farthest_mm = std::max(bounds_mm.min().length(), bounds_mm.max().length());
    if (!(voxels <= max_voxels) || !(farthest_mm / voxel_size_mm <= max_voxels_per_axis))
        throw InputError(
            fmt::format("grains.voxel_size_mm {:.4g}: {:.4g} x {:.4g} x {:.4g} mm would take {:.3g} voxels; at most "
                        "{:.3g} in all and {:.3g} from the origin are possible",
                        voxel_size_mm, extents_mm.x(), extents_mm.y(), extents_mm.z(), voxels, max_voxels, max_voxels_per_axis));
    return voxel_size_mm;
}

OpalConstants constants_of(const Recipe& recipe) {
    OpalConstants constants;
    constants.sphere_diameter_nm = recipe.crystal.sphere_diameter_nm;
    constants.n_sphere = recipe.crystal.n_sphere;
    constants.n_medium = recipe.crystal.n_medium;
    constants.coherence_length_um = recipe.crystal.coherence_length_um;
    constants.absorber = recipe.base_color.absorber;
    constants.sigma_a_per_mm = absorber_spectrum(recipe.base_color.absorber, recipe.base_color.sigma_a_per_mm);
    constants.sigma_s_rayleigh_400nm_per_mm = recipe.base_color.sigma_s_rayleigh_400nm_per_mm;
    constants.sigma_s_mie_per_mm = recipe.base_color.sigma_s_mie_per_mm;
    constants.mie_asymmetry = recipe.base_color.mie_asymmetry;
    return constants;
}

void describe_sites(const SiteSet& sites, BuildReport& report) {
    report.shape_volume_mm3 = sites.shape_volume_mm3;
    report.shortest_site_distance_mm = sites.shortest_distance_mm;
    report.relative_radius = sites.relative_radius;
}

/// Gives the sites their weights, and the asset the field behind them where the recipe asks for it.
void weigh(const Recipe& recipe, const SiteSet& sites, const Shape& shape, StageRunner& stages, BuildReport& report,
           OpalAsset& asset) {
    const GrainsRecipe& grains = recipe.grains;
    WeighedSites weighed = stages.run("weights", [&] { return weigh_sites(sites, grains, shape); });
    asset.sites = std::move(weighed.sites);
    report.weight_scale = weighed.weight_scale;
    if (weighed.weight_scale < 1.0)
        stages.warn(
            fmt::format("weights were multiplied by {:.4g}, so that neighbouring sites differ by less than their shortest "
                        "distance (grains.limit_weights)",
                        weighed.weight_scale));
    if (recipe.output.has(OutputGrid::weight))
        asset.weight = stages.run("weight_grid", [&] { return make_weight_grid(sites, grains, shape, weighed.weight_scale); });
}

void describe_sintering(const NeighbourGraph& graph, const std::vector<char>& hidden, const Sintering& sintering,
                        StageRunner& stages, BuildReport& report) {
    const auto visible = static_cast<std::size_t>(std::count(hidden.begin(), hidden.end(), char(0)));
    report.hidden_sites = hidden.size() - visible;
    report.bonds = graph.size();
    report.kept_bonds = sintering.num_kept_bonds;
    report.mean_degree = 2.0 * static_cast<double>(graph.size()) / static_cast<double>(visible);
    report.bond_probability = sintering.probability;
    report.largest_grain_fraction = sintering.largest_grain_fraction;
    report.percolation_threshold = sintering.threshold;
    if (hidden.size() > few_sites && sintering.largest_grain_fraction > large_grain_fraction)
        stages.warn(fmt::format("one grain holds {:.0f} % of the opal's sites (p {:.3g}; this graph percolates near p = {:.3g})",
                                100.0 * sintering.largest_grain_fraction, sintering.probability,
                                sintering.threshold.value_or(1.0)));
}

void describe_grid(const openvdb::Int32Grid& grain_id, BuildReport& report) {
    report.voxels = grain_id.activeVoxelCount();
    report.leaves = grain_id.tree().leafCount();
    report.tiles = grain_id.tree().activeTileCount();
}

void require_voxels(const openvdb::Int32Grid& grain_id, const openvdb::BBoxd& bounds_mm) {
    if (!grain_id.tree().empty()) return;
    const openvdb::Vec3d size_mm = bounds_mm.extents();
    throw InputError(
        fmt::format("grains.voxel_size_mm {:.4g}: no voxel's centre lies inside the shape of {:.4g} x {:.4g} x {:.4g} mm; "
                    "choose smaller voxels",
                    grain_id.voxelSize().x(), size_mm.x(), size_mm.y(), size_mm.z()));
}

}  // namespace

BuiltOpal build_opal(const Recipe& recipe, const BuildListener& listener) {
    initialize_openvdb();
    BuiltOpal built;
    OpalAsset& asset = built.asset;
    BuildReport& report = built.report;
    StageRunner stages(report, listener);

    asset.constants = constants_of(recipe);
    asset.seed = recipe.grains.seed;
    asset.tessellation = recipe.grains.tessellation;
    asset.boundary_noise = recipe.grains.boundary_noise;
    asset.recipe_toml = recipe_to_toml(recipe);
    asset.program_version = version_report()["opal"].get<std::string>();
    asset.schema_version = opal_schema_version;

    const auto shape = stages.run("shape", [&] { return make_shape(recipe.shape); });
    const double voxel_size_mm = resolve_voxel_size_mm(recipe, shape->bounds_mm());

    const SiteSet sites = stages.run(
        "sites", [&] { return sample_sites(*shape, static_cast<std::size_t>(recipe.grains.num_sites), recipe.grains.seed); });
    describe_sites(sites, report);
    weigh(recipe, sites, *shape, stages, report, asset);
    const std::vector<char> hidden =
        stages.run("hidden_sites", [&] { return find_hidden_sites(asset.sites, sites.spacing_mm(), asset.tessellation); });

    const NeighbourGraph graph = stages.run("neighbour_graph", [&] {
        return recipe.grains.sintering.graph == SinteringGraph::delaunay
                   ? delaunay_graph(asset.sites, hidden)
                   : apollonius_graph(asset.sites, hidden, *shape, sites.spacing_mm(), asset.tessellation);
    });
    const Sintering sintering =
        stages.run("sintering", [&] { return sinter(graph, hidden, recipe.grains.sintering, recipe.grains.seed); });
    describe_sintering(graph, hidden, sintering, stages, report);
    for (std::size_t n = 0; n < asset.sites.size(); ++n) asset.sites[n].grain = sintering.grain_of_site[n];

    asset.shape = stages.run("level_set", [&] { return shape->level_set(voxel_size_mm); });
    asset.grain_id = stages.run("labelling", [&] {
        return label_voxels(asset.sites, sintering.grain_of_site, *asset.shape,
                            {asset.tessellation, asset.boundary_noise, asset.seed});
    });
    require_voxels(*asset.grain_id, shape->bounds_mm());
    describe_grid(*asset.grain_id, report);

    asset.grain_orientations = stages.run("orientations", [&] {
        std::vector<openvdb::math::Quat<float>> orientations;
        for (std::int32_t grain = 1; grain <= sintering.num_grains; ++grain)
            orientations.push_back(random_orientation(recipe.grains.seed, false, static_cast<std::uint64_t>(grain)));
        return orientations;
    });
    return built;
}

}  // namespace opal
