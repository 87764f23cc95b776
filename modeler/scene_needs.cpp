// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/scene_needs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/error.h"
#include "formats/spectrum.h"
#include "formats/text.h"
#include "formats/units.h"
#include "modeler/defect_scattering.h"
#include "modeler/picture_view.h"
#include "modeler/surface_needs.h"

namespace opal {
namespace {

/// Half an 8-bit step of white.
constexpr double invisible_change = 0.5 / 255.0;
/// Of a voxel: from its centre to its corner.
const double half_diagonal = 0.5 * std::sqrt(3.0);
/// Along the longest side: below, the gem's own light changes, however few pixels it takes (docs/speed-and-accuracy.md).
constexpr double fewest_voxels = 32.0;
/// Along the shortest side, so that plates remain.
constexpr double fewest_of_thin = 4.0;
/// The same where only the surface takes voxels, which cost little.
constexpr double fewest_of_long_surface = 96.0, fewest_of_thin_surface = 16.0;
/// Along the longest side: finer ones, for an edge in a macro, fit no memory.
constexpr double most_voxels = 2000.0;
/// Of the surface, in the picture: with fewer, little is known of what it shows.
constexpr std::size_t fewest_places = 50;
/// Part of space that touching spheres fill in fcc packing.
const double fcc_fill = units::pi / (3.0 * std::sqrt(2.0));

/// The scene's objects that are the opal, by number.
std::vector<std::size_t> find_opal(const SceneDescription& scene, const std::filesystem::path& output) {
    std::vector<std::size_t> named, opals;
    std::vector<std::string> files;
    for (std::size_t n = 0; n < scene.objects.size(); ++n) {
        if (scene.objects[n].kind != ObjectKind::opal) continue;
        const std::string file = scene.objects[n].file.filename().string();
        opals.push_back(n);
        if (file == output.filename().string()) named.push_back(n);
        if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
    }
    if (!named.empty()) return named;
    if (opals.empty()) throw InputError("--for: the scene has no [[object]] of kind opal");
    if (files.size() > 1)
        throw InputError(fmt::format("--for: the scene has several opals ({}), none of them in a file named {}", join(files),
                                     output.filename().string()));
    return opals;
}

void drop_field(FieldRecipe& field, const std::string& name, double coefficient_per_mm, double longest_path_mm,
                SceneNeeds& needs) {
    if (field.kind == FieldKind::constant || field.kind == FieldKind::grid) return;
    const double change = 2.0 * field.contrast * coefficient_per_mm * longest_path_mm;
    if (change >= invisible_change) return;
    needs.dropped.push_back(fmt::format("{}: changes transmission by {:.2g} at most along a straight path", name, change));
    field = {};
}

/// The largest of the visible range.
double strongest_mie_per_mm(const Recipe& recipe) {
    if (!(recipe.base_color.defect_concentration > 0.0)) return recipe.base_color.sigma_s_mie_per_mm;
    const DefectScattering defects = defect_scattering(recipe.crystal, recipe.base_color);
    if (defects.shape.value.empty()) return 0.0;
    return defects.sigma_s_550nm_per_mm * *std::max_element(defects.shape.value.begin(), defects.shape.value.end());
}

/// Whether opal-render finds the grains of such a file without voxels; see docs/formats.md, opal.grains.
bool finds_grains_from_sites(const Recipe& recipe, const OpalDescription& settings) {
    const bool described =
        recipe.grains.tessellation == TessellationKind::additive || recipe.grains.tessellation == TessellationKind::voronoi;
    return settings.grains != GrainsKind::voxels && described && !(recipe.grains.boundary_noise.amplitude_mm > 0.0) &&
           recipe.output.has(OutputGrid::sites) && recipe.output.has(OutputGrid::shape);
}

void drop_what_does_not_show(Recipe& recipe, bool walks_cells, double longest_path_mm, SceneNeeds& needs) {
    BaseColorRecipe& color = recipe.base_color;
    // Rayleigh scattering is strongest at the short end of the visible range.
    const double rayleigh_at_360nm = std::pow(400.0 / 360.0, 4);
    const SampledSpectrum sigma_a_per_mm = absorber_spectrum(color.absorber, color.sigma_a_per_mm, color.sigma_a_reference_nm);
    const double strongest_per_mm = *std::max_element(sigma_a_per_mm.value.begin(), sigma_a_per_mm.value.end());
    drop_field(color.sigma_a_field, "sigma_a_field", strongest_per_mm, longest_path_mm, needs);
    drop_field(color.sigma_s_rayleigh_field, "sigma_s_rayleigh_field", color.sigma_s_rayleigh_400nm_per_mm * rayleigh_at_360nm,
               longest_path_mm, needs);
    drop_field(color.sigma_s_mie_field, "sigma_s_mie_field", strongest_mie_per_mm(recipe), longest_path_mm, needs);
    needs.exact_grains = walks_cells;
    if (walks_cells && recipe.output.has(OutputGrid::grain_id)) {
        std::erase(recipe.output.grids, OutputGrid::grain_id);
        needs.dropped.push_back("grid grain_id: the grains are taken from the sites, exactly");
    }
    if (recipe.output.has(OutputGrid::weight)) {
        std::erase(recipe.output.grids, OutputGrid::weight);
        needs.dropped.push_back("grid weight: nothing is rendered from it");
    }
    if (recipe.output.for_blender) {
        recipe.output.for_blender = false;
        needs.dropped.push_back("display twins for Blender: nothing is rendered from them");
    }
}

bool fields_vary(const Recipe& recipe) {
    const BaseColorRecipe& color = recipe.base_color;
    return recipe.output.has(OutputGrid::fields) &&
           (color.sigma_a_field.kind != FieldKind::constant || color.sigma_s_rayleigh_field.kind != FieldKind::constant ||
            color.sigma_s_mie_field.kind != FieldKind::constant);
}

double longest_side_mm(const Shape& shape) {
    const openvdb::Vec3d extents_mm = shape.bounds_mm().extents();
    return std::max({extents_mm.x(), extents_mm.y(), extents_mm.z()});
}

double shortest_side_mm(const Shape& shape) {
    const openvdb::Vec3d extents_mm = shape.bounds_mm().extents();
    return std::min({extents_mm.x(), extents_mm.y(), extents_mm.z()});
}

/// Voxels as coarse as the surface allows, where nothing but the surface takes any.
void follow_curvature(const Shape& shape, const std::vector<PictureView>& views, double accepted_error_pixels,
                      SceneNeeds& needs) {
    const double coarsest_mm =
        std::min(longest_side_mm(shape) / fewest_of_long_surface, shortest_side_mm(shape) / fewest_of_thin_surface);
    const double finest_mm = std::min(needs.voxel_size_mm, coarsest_mm);
    SurfaceNeeds surface = coarsest_surface_voxels(
        shape,
        [&](const openvdb::Vec3d& point_mm) {
            double footprint_mm = std::numeric_limits<double>::infinity();
            for (const PictureView& view : views) footprint_mm = std::min(footprint_mm, view.footprint_in_picture_mm(point_mm));
            return accepted_error_pixels * footprint_mm;
        },
        finest_mm, coarsest_mm);
    // What the picture shows of it then, it shows in mirrors: anything.
    if (surface.places < fewest_places)
        surface = coarsest_surface_voxels(
            shape, [&](const openvdb::Vec3d&) { return accepted_error_pixels * needs.pixel_footprint_mm; }, finest_mm,
            coarsest_mm);
    needs.voxel_size_mm = surface.voxel_size_mm;
    needs.surface_places = surface.places;
    // Whatever the shape, the sides of the voxels' centres are right.
    const double at_most_mm = half_diagonal * surface.voxel_size_mm;
    needs.boundary_error_mm = std::min(surface.error_mm, at_most_mm);
    needs.boundary_error_pixels =
        std::min(surface.error_over_accepted * accepted_error_pixels, at_most_mm / needs.pixel_footprint_mm);
    needs.finest_surface = surface.error_over_accepted > 1.0;
}

}  // namespace

SceneNeeds fit_to_scene(Recipe& recipe, const SceneDescription& scene, const std::filesystem::path& output, const Shape& shape,
                        double accepted_error_pixels) {
    const std::vector<std::size_t> objects = find_opal(scene, output);
    const std::vector<PictureView> views = picture_views(scene, objects);
    const double longest_mm = longest_side_mm(shape);
    SceneNeeds needs;
    needs.recipe_voxel_size_mm = recipe.resolution > 0 ? longest_mm / recipe.resolution : recipe.grains.voxel_size_mm;
    needs.pixel_footprint_mm = std::numeric_limits<double>::infinity();
    for (const PictureView& view : views)
        needs.pixel_footprint_mm = std::min(needs.pixel_footprint_mm, view.nearest_footprint_mm(shape.bounds_mm()));
    drop_what_does_not_show(recipe, finds_grains_from_sites(recipe, scene.opal), shape.bounds_mm().extents().length(), needs);
    if (needs.pixel_footprint_mm > 0.0) {
        needs.voxel_size_mm = std::max(std::min({accepted_error_pixels * needs.pixel_footprint_mm / half_diagonal,
                                                 longest_mm / fewest_voxels, shortest_side_mm(shape) / fewest_of_thin}),
                                       longest_mm / most_voxels);
        needs.boundary_error_mm = half_diagonal * needs.voxel_size_mm;
        needs.boundary_error_pixels = needs.boundary_error_mm / needs.pixel_footprint_mm;
        if (needs.exact_grains && !fields_vary(recipe)) follow_curvature(shape, views, accepted_error_pixels, needs);
        recipe.grains.voxel_size_mm = needs.voxel_size_mm;
        recipe.resolution = 0;
    } else {
        needs.voxel_size_mm = needs.recipe_voxel_size_mm;
        needs.boundary_error_mm = half_diagonal * needs.voxel_size_mm;
    }
    const double n_eff =
        fcc_fill * recipe.crystal.n_sphere.at(sodium_d_nm) + (1.0 - fcc_fill) * recipe.crystal.n_medium.at(sodium_d_nm);
    needs.lens_magnification = n_eff < 2.0 ? n_eff / (2.0 - n_eff) : std::numeric_limits<double>::infinity();
    return needs;
}

nlohmann::json scene_needs_to_json(const SceneNeeds& needs) {
    const double ratio = needs.recipe_voxel_size_mm / needs.voxel_size_mm;
    return {{"pixel_footprint_mm", needs.pixel_footprint_mm},
            {"voxel_size_mm", needs.voxel_size_mm},
            {"recipe_voxel_size_mm", needs.recipe_voxel_size_mm},
            {"voxels_over_recipe", ratio * ratio * ratio},
            {"boundary_error_mm", needs.boundary_error_mm},
            {"boundary_error_pixels", needs.boundary_error_pixels},
            {"lens_magnification", needs.lens_magnification},
            {"exact_grains", needs.exact_grains},
            {"surface_places", needs.surface_places},
            {"finest_surface", needs.finest_surface},
            {"dropped", needs.dropped}};
}

std::string scene_needs_summary(const SceneNeeds& needs) {
    if (!(needs.pixel_footprint_mm > 0.0))
        return "scene    the gem's box reaches behind the camera: the recipe's resolution is kept\n";
    const double ratio = std::pow(needs.recipe_voxel_size_mm / needs.voxel_size_mm, 3);
    std::string text = fmt::format(
        "scene    a pixel spans {:.3g} mm of the gem: voxels of {:.3g} mm, {:.3g} times as many as the recipe's\n"
        "         {} off by {:.3g} mm at most, {:.2g} pixels (up to {:.2g} where the gem's own lens "
        "magnifies)\n",
        needs.pixel_footprint_mm, needs.voxel_size_mm, ratio,
        needs.exact_grains ? "grains are exact; the surface is" : "grain boundaries are", needs.boundary_error_mm,
        needs.boundary_error_pixels, needs.boundary_error_pixels * needs.lens_magnification);
    if (needs.surface_places > 0)
        text += fmt::format("         {}, looked at in {} places\n",
                            needs.finest_surface ? "the finest voxels of use, for its edges or thin parts in the picture"
                                                 : "voxels follow its curvature in the picture",
                            needs.surface_places);
    for (const std::string& what : needs.dropped) text += fmt::format("         left out: {}\n", what);
    return text;
}

}  // namespace opal
