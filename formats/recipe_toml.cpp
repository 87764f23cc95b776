// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "formats/recipe.h"
#include "formats/recipe_names.h"
#include "formats/text.h"

namespace opal {
namespace {

namespace names = recipe_names;

/// TOML tells integers from floats: a float keeps its point.
std::string real(double value) {
    const std::string text = fmt::format("{}", value);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string vector3(const std::array<double, 3>& v) {
    return fmt::format("[{}, {}, {}]", real(v[0]), real(v[1]), real(v[2]));
}

template <typename Enum>
std::string quoted(const names::Names& spelled, Enum value) {
    return toml_quoted(names::name(spelled, value));
}

std::string quoted_file(const std::filesystem::path& file) {
    return toml_quoted(file.filename().string());
}

std::string index_to_toml(const RefractiveIndex& index) {
    return index.varies() ? quoted_file(index.name()) : real(index.at(sodium_d_nm));
}

std::string shape_to_toml(const ShapeRecipe& shape) {
    std::string text = fmt::format("[shape]\nkind = {}\n", quoted(names::shapes, shape.kind));
    if (shape.kind == ShapeKind::mesh)
        return text + fmt::format("file = {}\nscale = {}\n", quoted_file(shape.mesh_file), real(shape.mesh_scale));
    const bool bezier = shape.kind == ShapeKind::bezier;
    const bool teapot = bezier && shape.patches == BezierPatches::teapot;
    if (bezier) text += fmt::format("patches = {}\n", quoted(names::patches, shape.patches));
    text +=
        teapot ? fmt::format("longest_mm = {}\n", real(shape.longest_mm)) : fmt::format("size_mm = {}\n", vector3(shape.size_mm));
    if (shape.kind == ShapeKind::cabochon || (bezier && !teapot)) text += fmt::format("girdle_mm = {}\n", real(shape.girdle_mm));
    if (bezier) text += fmt::format("chord_error_mm = {}\n", real(shape.chord_error_mm));
    return text;
}

std::string sites_to_toml(const GrainsRecipe& grains) {
    const SitesRecipe& sites = grains.sites;
    if (sites.kind == SiteKind::file)
        return fmt::format("sites = {{ kind = {}, file = {}, scale = {} }}\n", quoted(names::sites, sites.kind),
                           quoted_file(sites.file), real(sites.file_scale));
    return fmt::format("num_sites = {}\nsites = {{ kind = {}, region = {}{} }}\n", grains.num_sites,
                       quoted(names::sites, sites.kind), quoted(names::regions, sites.region),
                       sites.kind == SiteKind::jittered_lattice ? ", jitter = " + real(sites.jitter) : std::string());
}

std::string weight_to_toml(const WeightTerm& term) {
    std::string text = fmt::format("{{ kind = {}, amplitude = {}, scale_mm = {}, octaves = {}", quoted(names::weights, term.kind),
                                   real(term.amplitude), real(term.scale_mm), term.octaves);
    if (term.kind == WeightKind::linear) text += ", direction = " + vector3(term.direction);
    if (term.kind == WeightKind::radial) text += ", center_mm = " + vector3(term.center_mm);
    if (!term.file.empty()) text += ", file = " + quoted_file(term.file);
    if (term.kind == WeightKind::grid) text += ", grid = " + toml_quoted(term.grid);
    return text + " }";
}

std::string weights_to_toml(const std::vector<WeightTerm>& terms) {
    if (terms.size() == 1) return fmt::format("weight = {}\n", weight_to_toml(terms.front()));
    std::string text = "weight = [";
    for (const WeightTerm& term : terms) text += (text.back() == '[' ? "" : ", ") + weight_to_toml(term);
    return text + "]\n";
}

std::string sintering_to_toml(const SinteringRecipe& sintering) {
    std::string text = fmt::format("sintering = {{ graph = {}, ", quoted(names::graphs, sintering.graph));
    if (sintering.target_grains > 0)
        text += fmt::format("grains = {}", sintering.target_grains);
    else if (sintering.mean_grain_mm > 0.0)
        text += fmt::format("mean_grain_mm = {}", real(sintering.mean_grain_mm));
    else
        text += fmt::format("probability = {}", real(sintering.probability));
    text += fmt::format(", preference = {}", quoted(names::preferences, sintering.preference));
    if (sintering.preference == BondPreference::misorientation)
        text += fmt::format(", misorientation_deg = {}", real(sintering.misorientation_deg));
    return text + " }\n";
}

std::string orientation_to_toml(const OrientationRecipe& orientation) {
    std::string text = fmt::format("orientation = {{ kind = {}", quoted(names::orientations, orientation.kind));
    if (orientation.kind == OrientationKind::fibre)
        text += fmt::format(", axis = {}, lattice = {}, spread_deg = {}", vector3(orientation.axis), vector3(orientation.lattice),
                            real(orientation.spread_deg));
    if (orientation.kind == OrientationKind::table) text += fmt::format(", file = {}", quoted_file(orientation.file));
    return text + " }\n";
}

std::string grains_to_toml(const Recipe& recipe) {
    const GrainsRecipe& grains = recipe.grains;
    std::string text = "\n[grains]\n" + sites_to_toml(grains);
    text += recipe.resolution > 0 ? fmt::format("resolution = {}\n", recipe.resolution)
                                  : fmt::format("voxel_size_mm = {}\n", real(grains.voxel_size_mm));
    text += fmt::format("seed = {}\ntessellation = {}\n", grains.seed, quoted(names::tessellations, grains.tessellation));
    text += weights_to_toml(grains.weight) + fmt::format("limit_weights = {}\n", grains.limit_weights);
    text += fmt::format("boundary_noise = {{ amplitude_mm = {}, scale_mm = {}, octaves = {} }}\n",
                        real(grains.boundary_noise.amplitude_mm), real(grains.boundary_noise.scale_mm),
                        grains.boundary_noise.octaves);
    return text + sintering_to_toml(grains.sintering) + orientation_to_toml(grains.orientation);
}

std::string field_to_toml(const std::string& key, const FieldRecipe& field) {
    std::string text = fmt::format("{} = {{ kind = {}", key, quoted(names::fields, field.kind));
    if (field.kind == FieldKind::grid)
        text += fmt::format(", file = {}, grid = {}", quoted_file(field.file), toml_quoted(field.grid));
    else if (field.kind != FieldKind::constant)
        text += fmt::format(", contrast = {}", real(field.contrast));
    if (field.kind == FieldKind::noise || field.kind == FieldKind::layers)
        text += fmt::format(", scale_mm = {}", real(field.scale_mm));
    if (field.kind == FieldKind::noise) text += fmt::format(", octaves = {}", field.octaves);
    if (field.kind == FieldKind::layers) text += fmt::format(", direction = {}", vector3(field.direction));
    if (field.kind != FieldKind::constant) text += fmt::format(", voxel_size_mm = {}", real(field.voxel_size_mm));
    return text + " }\n";
}

std::string base_color_to_toml(const BaseColorRecipe& color) {
    return fmt::format(
               "\n[base_color]\nabsorber = {}\nsigma_a_per_mm = {}\nsigma_a_reference_nm = {}\nsigma_s_rayleigh_400nm_per_mm = "
               "{}\n",
               quoted_file(color.absorber), real(color.sigma_a_per_mm), real(color.sigma_a_reference_nm),
               real(color.sigma_s_rayleigh_400nm_per_mm)) +
           (color.defect_concentration > 0.0 ? fmt::format("defect_concentration = {}\n", real(color.defect_concentration))
                                             : fmt::format("sigma_s_mie_per_mm = {}\n", real(color.sigma_s_mie_per_mm))) +
           fmt::format(
               "mie_phase = {}\nmie_asymmetry = {}\ndraine_alpha = {}\nmie_particle = {}\nmie_particle_diameter_nm = {}\n",
               quoted(names::mie_phases, color.mie_phase), real(color.mie_asymmetry), real(color.draine_alpha),
               quoted(names::mie_particles, color.mie_particle), real(color.mie_particle_diameter_nm)) +
           field_to_toml("sigma_a_field", color.sigma_a_field) +
           field_to_toml("sigma_s_rayleigh_field", color.sigma_s_rayleigh_field) +
           field_to_toml("sigma_s_mie_field", color.sigma_s_mie_field);
}

std::string output_to_toml(const OutputRecipe& output) {
    std::string text = "\n[output]\ngrids = [";
    for (const OutputGrid grid : output.grids) text += (text.back() == '[' ? "" : ", ") + quoted(names::grids, grid);
    return text + fmt::format("]\nfor_blender = {}\n", output.for_blender);
}

}  // namespace

std::string recipe_to_toml(const Recipe& recipe) {
    const CrystalRecipe& crystal = recipe.crystal;
    return shape_to_toml(recipe.shape) + grains_to_toml(recipe) +
           fmt::format(
               "\n[crystal]\nsphere_diameter_nm = {}\nn_sphere = {}\nn_medium = {}\ncoherence_length_um = {}\n"
               "stacking_fault_probability = {}\nmosaic_spread_deg = {}\n",
               real(crystal.sphere_diameter_nm), index_to_toml(crystal.n_sphere), index_to_toml(crystal.n_medium),
               real(crystal.coherence_length_um), real(crystal.stacking_fault_probability), real(crystal.mosaic_spread_deg)) +
           base_color_to_toml(recipe.base_color) + output_to_toml(recipe.output);
}

}  // namespace opal
