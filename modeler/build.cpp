// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/error.h"
#include "formats/field_summary.h"
#include "formats/report.h"
#include "modeler/base_color_fields.h"
#include "modeler/defect_scattering.h"
#include "modeler/grain_growth.h"
#include "modeler/labelling.h"
#include "modeler/level_set.h"
#include "modeler/shape.h"
#include "modeler/site_network.h"
#include "modeler/stage_runner.h"

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
    constants.stacking_fault_probability = recipe.crystal.stacking_fault_probability;
    constants.mosaic_spread_deg = recipe.crystal.mosaic_spread_deg;
    // Without its folder, so that the same input gives the same file wherever it lies.
    constants.absorber = std::filesystem::path(recipe.base_color.absorber).filename().string();
    constants.sigma_a_per_mm =
        absorber_spectrum(recipe.base_color.absorber, recipe.base_color.sigma_a_per_mm, recipe.base_color.sigma_a_reference_nm);
    constants.sigma_s_rayleigh_400nm_per_mm = recipe.base_color.sigma_s_rayleigh_400nm_per_mm;
    constants.sigma_s_mie_per_mm = recipe.base_color.sigma_s_mie_per_mm;
    constants.mie_phase = recipe.base_color.mie_phase;
    constants.mie_asymmetry = recipe.base_color.mie_asymmetry;
    constants.draine_alpha = recipe.base_color.draine_alpha;
    constants.mie_particle = recipe.base_color.mie_particle;
    constants.mie_particle_diameter_nm = recipe.base_color.mie_particle_diameter_nm;
    return constants;
}

/// Turns a concentration of defects into the coefficient that follows from it, which the recipe then holds beside it; returns how
/// that varies over the wavelength.
SampledSpectrum resolve_defects(Recipe& recipe) {
    if (!(recipe.base_color.defect_concentration > 0.0)) return {};
    const DefectScattering defects = defect_scattering(recipe.crystal, recipe.base_color);
    recipe.base_color.sigma_s_mie_per_mm = defects.sigma_s_550nm_per_mm;
    return defects.shape;
}

/// What the asset takes over from the recipe as it stands.
void describe_origin(const Recipe& recipe, const SampledSpectrum& sigma_s_mie_shape, OpalAsset& asset) {
    asset.constants = constants_of(recipe);
    asset.constants.sigma_s_mie_shape = sigma_s_mie_shape;
    asset.tessellation = recipe.grains.tessellation;
    asset.boundary_noise = recipe.grains.boundary_noise;
    asset.seed = recipe.grains.seed;
    asset.recipe_toml = recipe_to_toml(recipe);
    asset.program_version = version_report()["opal"].get<std::string>();
    asset.schema_version = opal_schema_version;
}

void describe_sites(const SiteSet& sites, BuildReport& report) {
    report.shape_volume_mm3 = sites.shape_volume_mm3;
    report.shortest_site_distance_mm = sites.shortest_distance_mm;
    report.relative_radius = sites.relative_radius;
}

void describe_sintering(const SiteNetwork& network, const Sintering& sintering, StageRunner& stages, BuildReport& report) {
    report.hidden_sites = network.hidden.size() - network.num_visible();
    report.bonds = network.graph.size();
    report.kept_bonds = sintering.num_kept_bonds;
    report.mean_degree = network.mean_degree();
    report.bond_probability = sintering.probability;
    report.largest_grain_fraction = sintering.largest_grain_fraction;
    report.percolation_threshold = sintering.threshold;
    if (network.sites.size() > few_sites && sintering.largest_grain_fraction > large_grain_fraction)
        stages.warn(fmt::format("one grain holds {:.0f} % of the opal's sites (p {:.3g}, threshold about {:.2g})",
                                100.0 * sintering.largest_grain_fraction, sintering.probability,
                                sintering.threshold.value_or(1.0)));
}

void describe_grid(const openvdb::Int32Grid& grain_id, BuildReport& report) {
    report.voxels = grain_id.activeVoxelCount();
    report.voxels_in_box = grain_id.evalActiveVoxelBoundingBox().volume();
    report.leaves = grain_id.tree().leafCount();
    report.tiles = grain_id.tree().activeTileCount();
}

[[noreturn]] void fail_without_inside(double voxel_size_mm, const openvdb::BBoxd& bounds_mm) {
    const openvdb::Vec3d size_mm = bounds_mm.extents();
    throw InputError(
        fmt::format("grains.voxel_size_mm {:.4g}: no voxel's centre lies inside the shape of {:.4g} x {:.4g} x {:.4g} mm; "
                    "choose smaller voxels",
                    voxel_size_mm, size_mm.x(), size_mm.y(), size_mm.z()));
}

/// A level set that is positive everywhere has no surface to be drawn.
void require_inside(const openvdb::FloatGrid& level_set, const openvdb::BBoxd& bounds_mm) {
    for (auto value = level_set.cbeginValueOn(); value; ++value)
        if (*value < 0.0f) return;
    fail_without_inside(level_set.voxelSize().x(), bounds_mm);
}

/// A file of sites alone takes no voxels, whatever their size.
bool needs_voxels(const OutputRecipe& output) {
    return output.grids != std::vector<OutputGrid>{OutputGrid::sites};
}

bool has_fields(const BaseColorRecipe& color) {
    return color.sigma_a_field.kind != FieldKind::constant || color.sigma_s_rayleigh_field.kind != FieldKind::constant ||
           color.sigma_s_mie_field.kind != FieldKind::constant;
}

/// The stages level_set, labelling and fields, as far as the recipe's output asks for them.
void add_voxels(const Recipe& recipe, const Shape& shape, double voxel_size_mm, StageRunner& stages, BuildReport& report,
                OpalAsset& asset) {
    asset.shape = stages.run("level_set", [&] { return shape.level_set(voxel_size_mm); });
    require_inside(*asset.shape, shape.bounds_mm());
    std::vector<std::int32_t> grain_of_site;
    for (const Site& site : asset.sites) grain_of_site.push_back(site.grain);
    const auto label = [&](const openvdb::FloatGrid& level_set) {
        return label_voxels(asset.sites, grain_of_site, level_set, {asset.tessellation, asset.boundary_noise, asset.seed});
    };
    if (recipe.output.has(OutputGrid::grain_id)) {
        asset.grain_id = stages.run("labelling", [&] { return label(*asset.shape); });
        if (asset.grain_id->tree().empty()) fail_without_inside(voxel_size_mm, shape.bounds_mm());
        describe_grid(*asset.grain_id, report);
    }
    if (!has_fields(recipe.base_color) || !recipe.output.has(OutputGrid::fields)) return;
    stages.run("fields", [&] {
        add_base_color_fields(recipe.base_color, shape, label, asset);
        return varying_coefficients(asset).size();
    });
}

}  // namespace

BuiltOpal build_opal(const Recipe& asked_for, const BuildListener& listener, const std::optional<SceneFit>& scene_fit) {
    initialize_openvdb();
    Recipe recipe = asked_for;
    if (recipe.output.for_blender && !recipe.output.has(OutputGrid::grain_id))
        throw InputError("output.for_blender: its display twins are made from grain_id, which output.grids leaves out");
    BuiltOpal built;
    OpalAsset& asset = built.asset;
    BuildReport& report = built.report;
    StageRunner stages(report, listener);

    const auto shape = stages.run("shape", [&] { return make_shape(recipe.shape); });
    if (scene_fit)
        report.scene_needs = stages.run("scene_needs", [&] {
            return fit_to_scene(recipe, scene_fit->scene, scene_fit->output, *shape, scene_fit->accepted_error_pixels);
        });
    built.output = recipe.output;
    const SampledSpectrum sigma_s_mie_shape = resolve_defects(recipe);
    describe_origin(recipe, sigma_s_mie_shape, asset);
    const double voxel_size_mm = needs_voxels(recipe.output) ? resolve_voxel_size_mm(recipe, shape->bounds_mm()) : 0.0;

    SiteNetwork network = make_site_network(recipe, *shape, stages);
    for (const std::string& warning : network.site_set.warnings) stages.warn(warning);
    describe_sites(network.site_set, report);
    const GrainGrowth growth = grow_grains(recipe, network, stages);
    const Sintering& sintering = growth.sintering;
    describe_sintering(network, sintering, stages, report);
    report.weight_scale = network.weight_scale;
    asset.sites = std::move(network.sites);
    asset.weight = network.weight_grid;
    for (std::size_t n = 0; n < asset.sites.size(); ++n) asset.sites[n].grain = sintering.grain_of_site[n];
    asset.bezier_patches = shape->bezier_patches();
    if (has_fields(recipe.base_color) && !recipe.output.has(OutputGrid::fields))
        stages.warn("base_color has fields, but output.grids leaves them out: the file holds the constant coefficients alone");
    if (needs_voxels(recipe.output)) add_voxels(recipe, *shape, voxel_size_mm, stages, report, asset);
    asset.grain_orientations = growth.grain_orientations;
    report.grain_statistics = stages.run("grain_statistics", [&] { return grain_statistics(asset, network.graph); });
    return built;
}

}  // namespace opal
