// SPDX-License-Identifier: Apache-2.0
#include "formats/recipe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/text.h"
#include "formats/toml_reader.h"

namespace opal {
namespace {

const std::vector<std::string> shape_names = {"ellipsoid", "sphere", "box", "cabochon", "mesh"};
const std::vector<std::string> tessellation_names = {"additive", "voronoi"};
const std::vector<std::string> weight_names = {"none", "perlin"};
const std::vector<std::string> graph_names = {"apollonius", "delaunay"};
const ExclusiveKeys exclusive_keys = {{"grains.voxel_size_mm", "grains.resolution"},
                                      {"grains.sintering.probability", "grains.sintering.grains"}};

template <typename Enum>
Enum enum_from(const std::vector<std::string>& names, const std::string& name) {
    return static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
}

template <typename Enum>
const std::string& name_from(const std::vector<std::string>& names, Enum value) {
    return names[static_cast<std::size_t>(value)];
}

ShapeRecipe read_shape(TomlSection section) {
    ShapeRecipe shape;
    if (!section.has("kind")) section.fail("kind", "is needed: the shape has no default");
    shape.kind = enum_from<ShapeKind>(shape_names, section.choice("kind", "", shape_names));
    if (shape.kind == ShapeKind::mesh) {
        shape.mesh_file = section.path("file");
        if (shape.mesh_file.empty()) section.fail("file", "a mesh shape needs a file");
        shape.mesh_scale = section.number("scale", shape.mesh_scale, NumberRange::positive(1.0e9));
    } else {
        shape.size_mm = section.vector3("size_mm", shape.size_mm, NumberRange::positive(1.0e7), true);
        if (shape.kind == ShapeKind::sphere) {
            if (!section.has("size_mm")) shape.size_mm = {10.0, 10.0, 10.0};
            if (shape.size_mm[0] != shape.size_mm[1] || shape.size_mm[0] != shape.size_mm[2])
                section.fail("size_mm", "a sphere's three sizes must be equal; kind = \"ellipsoid\" allows others");
        }
        if (shape.kind == ShapeKind::cabochon) {
            const double smallest = std::min({shape.size_mm[0], shape.size_mm[1], shape.size_mm[2]});
            shape.girdle_mm =
                section.number("girdle_mm", std::round(0.15e6 * smallest) * 1.0e-6, NumberRange{0.0, 0.9 * smallest, true});
        }
    }
    section.finish();
    return shape;
}

WeightRecipe read_weight(TomlSection section) {
    WeightRecipe weight;
    weight.kind = enum_from<WeightKind>(weight_names, section.choice("kind", "perlin", weight_names));
    weight.amplitude = section.number("amplitude", weight.amplitude, NumberRange::from_zero(100.0));
    weight.scale_mm = section.number("scale_mm", weight.scale_mm, NumberRange::between(1.0e-6, 1.0e7));
    weight.octaves = static_cast<int>(section.integer("octaves", weight.octaves, 1, 16));
    section.finish();
    return weight;
}

SinteringRecipe read_sintering(TomlSection section, std::int64_t num_sites) {
    SinteringRecipe sintering;
    sintering.graph = enum_from<SinteringGraph>(graph_names, section.choice("graph", "apollonius", graph_names));
    if (section.has("probability") && section.has("grains"))
        section.fail("grains", "give either probability or grains, not both");
    sintering.probability = section.number("probability", sintering.probability, NumberRange::between(0.0, 1.0));
    sintering.target_grains = section.has("grains") ? section.integer("grains", 1, 1, num_sites) : 0;
    section.finish();
    return sintering;
}

GrainsRecipe read_grains(TomlSection section, int& resolution) {
    GrainsRecipe grains;
    grains.num_sites = section.integer("num_sites", grains.num_sites, 1, 50'000'000);
    if (section.has("voxel_size_mm") && section.has("resolution"))
        section.fail("resolution", "give either voxel_size_mm or resolution, not both");
    grains.voxel_size_mm = section.number("voxel_size_mm", 0.0, NumberRange{1.0e-4, 1.0e6, false});
    resolution = static_cast<int>(section.integer("resolution", section.has("voxel_size_mm") ? 0 : 256, 4, 4096));
    grains.seed = static_cast<std::uint64_t>(section.integer("seed", 1, 0, INT64_MAX));
    grains.tessellation =
        enum_from<TessellationKind>(tessellation_names, section.choice("tessellation", "additive", tessellation_names));
    grains.weight = read_weight(section.section("weight"));
    grains.sintering = read_sintering(section.section("sintering"), grains.num_sites);
    section.finish();
    return grains;
}

CrystalRecipe read_crystal(TomlSection section) {
    CrystalRecipe crystal;
    crystal.sphere_diameter_nm =
        section.number("sphere_diameter_nm", crystal.sphere_diameter_nm, NumberRange::between(50.0, 1000.0));
    crystal.n_sphere = section.number("n_sphere", crystal.n_sphere, NumberRange::between(1.0, 4.0));
    crystal.n_medium = section.number("n_medium", crystal.n_medium, NumberRange::between(1.0, 4.0));
    crystal.coherence_length_um =
        section.number("coherence_length_um", crystal.coherence_length_um, NumberRange::between(0.5, 1.0e4));
    section.finish();
    return crystal;
}

BaseColorRecipe read_base_color(TomlSection section) {
    const NumberRange coefficient = NumberRange::from_zero(1.0e6);
    BaseColorRecipe color;
    color.absorber = section.text("absorber", color.absorber);
    if (color.absorber.ends_with(".csv")) color.absorber = section.path("absorber").string();
    color.sigma_a_per_mm = section.number("sigma_a_per_mm", color.sigma_a_per_mm, coefficient);
    color.sigma_s_rayleigh_400nm_per_mm = section.number("sigma_s_rayleigh_400nm_per_mm", 0.0, coefficient);
    color.sigma_s_mie_per_mm = section.number("sigma_s_mie_per_mm", 0.0, coefficient);
    color.mie_asymmetry = section.number("mie_asymmetry", color.mie_asymmetry, NumberRange::between(-0.99, 0.99));
    section.finish();
    return color;
}

Recipe read_document(const TomlDocument& document) {
    Recipe recipe;
    TomlSection root = document.root();
    if (!root.has("shape")) root.fail("shape", "is needed: a [shape] table with a kind");
    recipe.shape = read_shape(root.section("shape"));
    recipe.grains = read_grains(root.section("grains"), recipe.resolution);
    recipe.crystal = read_crystal(root.section("crystal"));
    recipe.base_color = read_base_color(root.section("base_color"));
    root.finish();
    return recipe;
}

/// TOML tells integers from floats: a float keeps its point.
std::string real(double value) {
    const std::string text = fmt::format("{}", value);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

}  // namespace

Recipe read_recipe(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    return read_document(TomlDocument(file, overrides, exclusive_keys));
}

Recipe parse_recipe(const std::string& text, const std::string& name, const std::vector<std::string>& overrides) {
    return read_document(TomlDocument(text, name, overrides, exclusive_keys));
}

std::string recipe_to_toml(const Recipe& recipe) {
    const ShapeRecipe& shape = recipe.shape;
    std::string text = fmt::format("[shape]\nkind = {}\n", toml_quoted(name_from(shape_names, shape.kind)));
    if (shape.kind == ShapeKind::mesh)
        text += fmt::format("file = {}\nscale = {}\n", toml_quoted(shape.mesh_file.filename().string()), real(shape.mesh_scale));
    else
        text += fmt::format("size_mm = [{}, {}, {}]\n", real(shape.size_mm[0]), real(shape.size_mm[1]), real(shape.size_mm[2]));
    if (shape.kind == ShapeKind::cabochon) text += fmt::format("girdle_mm = {}\n", real(shape.girdle_mm));

    const GrainsRecipe& grains = recipe.grains;
    text += fmt::format("\n[grains]\nnum_sites = {}\n", grains.num_sites);
    text += recipe.resolution > 0 ? fmt::format("resolution = {}\n", recipe.resolution)
                                  : fmt::format("voxel_size_mm = {}\n", real(grains.voxel_size_mm));
    text += fmt::format("seed = {}\ntessellation = {}\n", grains.seed,
                        toml_quoted(name_from(tessellation_names, grains.tessellation)));
    text += fmt::format("weight = {{ kind = {}, amplitude = {}, scale_mm = {}, octaves = {} }}\n",
                        toml_quoted(name_from(weight_names, grains.weight.kind)), real(grains.weight.amplitude),
                        real(grains.weight.scale_mm), grains.weight.octaves);
    text += fmt::format("sintering = {{ graph = {}, {} }}\n", toml_quoted(name_from(graph_names, grains.sintering.graph)),
                        grains.sintering.target_grains > 0 ? fmt::format("grains = {}", grains.sintering.target_grains)
                                                           : "probability = " + real(grains.sintering.probability));

    const CrystalRecipe& crystal = recipe.crystal;
    text += fmt::format("\n[crystal]\nsphere_diameter_nm = {}\nn_sphere = {}\nn_medium = {}\ncoherence_length_um = {}\n",
                        real(crystal.sphere_diameter_nm), real(crystal.n_sphere), real(crystal.n_medium),
                        real(crystal.coherence_length_um));

    const BaseColorRecipe& color = recipe.base_color;
    text += fmt::format(
        "\n[base_color]\nabsorber = {}\nsigma_a_per_mm = {}\nsigma_s_rayleigh_400nm_per_mm = {}\nsigma_s_mie_per_mm = {}\n"
        "mie_asymmetry = {}\n",
        toml_quoted(std::filesystem::path(color.absorber).filename().string()), real(color.sigma_a_per_mm),
        real(color.sigma_s_rayleigh_400nm_per_mm), real(color.sigma_s_mie_per_mm), real(color.mie_asymmetry));
    return text;
}

}  // namespace opal
