// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/scene_needs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/error.h"
#include "formats/spectrum.h"
#include "formats/units.h"
#include "modeler/defect_scattering.h"
#include "modeler/surface_needs.h"

namespace opal {
namespace {

/// Half an 8-bit step of white.
constexpr double invisible_change = 0.5 / 255.0;
/// Of a voxel: from its centre to its corner.
const double half_diagonal = 0.5 * std::sqrt(3.0);
/// Along the longest side: below, the gem's own light changes, however few pixels it takes (docs/speed-and-accuracy.md).
constexpr double fewest_voxels = 32.0;
/// Where only the surface takes voxels, and pixels could show more of it than its curvature needs: along the longest side, and
/// along the shortest.
constexpr double fewest_of_long_surface = 64.0, fewest_of_thin_surface = 16.0;
/// Part of space that touching spheres fill in fcc packing.
const double fcc_fill = units::pi / (3.0 * std::sqrt(2.0));

const ObjectDescription& find_opal(const SceneDescription& scene, const std::filesystem::path& output) {
    std::vector<const ObjectDescription*> opals;
    std::string files;
    for (const ObjectDescription& object : scene.objects) {
        if (object.kind != ObjectKind::opal) continue;
        if (object.file.filename() == output.filename()) return object;
        opals.push_back(&object);
        files += (files.empty() ? "" : ", ") + object.file.filename().string();
    }
    if (opals.size() == 1) return *opals.front();
    if (opals.empty()) throw InputError("--for: the scene has no [[object]] of kind opal");
    throw InputError(fmt::format("--for: the scene has several opals ({}), none of them in a file named {}", files,
                                 output.filename().string()));
}

openvdb::Vec3d rotated(openvdb::Vec3d v, const std::array<double, 3>& rotate_deg) {
    for (int axis = 0; axis < 3; ++axis) {
        const double angle_rad = units::rad_from_deg(rotate_deg[static_cast<std::size_t>(axis)]);
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        const double va = std::cos(angle_rad) * v[a] - std::sin(angle_rad) * v[b];
        v[b] = std::sin(angle_rad) * v[a] + std::cos(angle_rad) * v[b];
        v[a] = va;
    }
    return v;
}

/// What a scene's camera sees of the opal's own space.
class PictureView {
  public:
    PictureView(const SceneDescription& scene, const ObjectDescription& opal)
        : camera_(scene.camera),
          opal_(opal),
          position_mm_(scene.camera.position_mm.data()),
          forward_((openvdb::Vec3d(scene.camera.target_mm.data()) - position_mm_).unitSafe()),
          right_(forward_.cross(openvdb::Vec3d(scene.camera.up.data())).unitSafe()),
          half_width_(0.5 * scene.render.width / scene.render.height),
          height_px_(scene.render.height) {}

    /// Edge of a pixel's share of the picture at the point of the gem's box that is nearest to the camera, in the opal's mm; 0
    /// where the camera is in the box.
    double nearest_footprint_mm(const openvdb::BBoxd& bounds_mm) const {
        double nearest_mm = std::numeric_limits<double>::infinity();
        for (int corner = 0; corner < 8; ++corner) {
            openvdb::Vec3d point_mm;
            for (int axis = 0; axis < 3; ++axis)
                point_mm[axis] = (corner >> axis & 1) != 0 ? bounds_mm.max()[axis] : bounds_mm.min()[axis];
            nearest_mm = std::min(nearest_mm, from_camera_mm(point_mm).dot(forward_));
        }
        return footprint_mm(nearest_mm);
    }

    /// The same at a point of the opal; infinite where that is not in the picture.
    double footprint_in_picture_mm(const openvdb::Vec3d& point_mm) const {
        const openvdb::Vec3d offset_mm = from_camera_mm(point_mm);
        const double depth_mm = offset_mm.dot(forward_);
        const double half_height_mm = (0.5 + picture_margin) * picture_height_mm(depth_mm);
        const bool beside = std::abs(offset_mm.dot(right_)) > 2.0 * half_width_ * half_height_mm ||
                            std::abs(offset_mm.dot(right_.cross(forward_))) > half_height_mm;
        return depth_mm <= 0.0 || beside ? std::numeric_limits<double>::infinity() : footprint_mm(depth_mm);
    }

  private:
    /// Seen, for what lies beside the picture by this part of its height: a lens out of focus, a filter's reach.
    static constexpr double picture_margin = 0.05;

    openvdb::Vec3d from_camera_mm(const openvdb::Vec3d& point_mm) const {
        return rotated(point_mm * opal_.scale, opal_.rotate_deg) + openvdb::Vec3d(opal_.translate_mm.data()) - position_mm_;
    }

    double picture_height_mm(double depth_mm) const {
        if (camera_.kind != CameraKind::perspective) return camera_.view_height_mm;
        return 2.0 * std::max(0.0, depth_mm) * std::tan(0.5 * units::rad_from_deg(camera_.vertical_fov_deg));
    }

    double footprint_mm(double depth_mm) const { return picture_height_mm(depth_mm) / height_px_ / opal_.scale; }

    const CameraDescription& camera_;
    const ObjectDescription& opal_;
    const openvdb::Vec3d position_mm_, forward_, right_;
    const double half_width_, height_px_;
};

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

/// Voxels as coarse as the surface allows, where nothing but the surface takes any.
void follow_curvature(const SceneDescription& scene, const Shape& shape, const PictureView& view, double accepted_error_pixels,
                      SceneNeeds& needs) {
    const openvdb::Vec3d extents_mm = shape.bounds_mm().extents();
    const double coarsest_mm = std::min(std::max({extents_mm.x(), extents_mm.y(), extents_mm.z()}) / fewest_of_long_surface,
                                        std::min({extents_mm.x(), extents_mm.y(), extents_mm.z()}) / fewest_of_thin_surface);
    if (coarsest_mm <= needs.voxel_size_mm) return;
    // Other frames may show any side of it.
    const bool moves = scene.animation.frames > 1;
    const SurfaceNeeds surface = coarsest_surface_voxels(
        shape,
        [&](const openvdb::Vec3d& point_mm) {
            return accepted_error_pixels * (moves ? needs.pixel_footprint_mm : view.footprint_in_picture_mm(point_mm));
        },
        needs.voxel_size_mm, coarsest_mm);
    needs.voxel_size_mm = surface.voxel_size_mm;
    needs.surface_places = surface.places;
    if (surface.error_over_accepted <= 1.0) {
        needs.boundary_error_mm = surface.error_mm;
        needs.boundary_error_pixels = surface.error_over_accepted * accepted_error_pixels;
    }
}

}  // namespace

SceneNeeds fit_to_scene(Recipe& recipe, const SceneDescription& scene, const std::filesystem::path& output, const Shape& shape,
                        double accepted_error_pixels) {
    const ObjectDescription& opal = find_opal(scene, output);
    const PictureView view(scene, opal);
    const openvdb::Vec3d extents_mm = shape.bounds_mm().extents();
    const double longest_mm = std::max({extents_mm.x(), extents_mm.y(), extents_mm.z()});
    SceneNeeds needs;
    needs.recipe_voxel_size_mm = recipe.resolution > 0 ? longest_mm / recipe.resolution : recipe.grains.voxel_size_mm;
    needs.pixel_footprint_mm = view.nearest_footprint_mm(shape.bounds_mm());
    drop_what_does_not_show(recipe, finds_grains_from_sites(recipe, scene.opal), extents_mm.length(), needs);
    needs.voxel_size_mm = needs.recipe_voxel_size_mm;
    if (needs.pixel_footprint_mm > 0.0)
        needs.voxel_size_mm =
            std::min(accepted_error_pixels * needs.pixel_footprint_mm / half_diagonal, longest_mm / fewest_voxels);
    needs.boundary_error_mm = half_diagonal * needs.voxel_size_mm;
    if (needs.pixel_footprint_mm > 0.0) {
        needs.boundary_error_pixels = needs.boundary_error_mm / needs.pixel_footprint_mm;
        if (needs.exact_grains && !fields_vary(recipe)) follow_curvature(scene, shape, view, accepted_error_pixels, needs);
        recipe.grains.voxel_size_mm = needs.voxel_size_mm;
        recipe.resolution = 0;
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
            {"dropped", needs.dropped}};
}

std::string scene_needs_summary(const SceneNeeds& needs) {
    if (!(needs.pixel_footprint_mm > 0.0))
        return "scene    the camera is within the gem's box: the recipe's resolution is kept\n";
    const double ratio = std::pow(needs.recipe_voxel_size_mm / needs.voxel_size_mm, 3);
    std::string text = fmt::format(
        "scene    a pixel spans {:.3g} mm of the gem: voxels of {:.3g} mm, {:.3g} times as many as the recipe's\n"
        "         {} off by {:.3g} mm at most, {:.2g} pixels (up to {:.2g} where the gem's own lens "
        "magnifies)\n",
        needs.pixel_footprint_mm, needs.voxel_size_mm, ratio,
        needs.exact_grains ? "grains are exact; the surface is" : "grain boundaries are", needs.boundary_error_mm,
        needs.boundary_error_pixels, needs.boundary_error_pixels * needs.lens_magnification);
    if (needs.surface_places > 0)
        text +=
            fmt::format("         voxels follow its curvature, looked at in {} places in the picture\n", needs.surface_places);
    for (const std::string& what : needs.dropped) text += fmt::format("         left out: {}\n", what);
    return text;
}

}  // namespace opal
