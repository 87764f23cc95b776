// SPDX-License-Identifier: Apache-2.0
#include "formats/recipe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/error.h"
#include "formats/recipe_names.h"
#include "formats/toml_reader.h"
#include "formats/units.h"

namespace opal {
namespace {

constexpr std::int64_t max_sites = 50'000'000;
const ExclusiveKeys exclusive_keys = {{"grains.voxel_size_mm", "grains.resolution"},
                                      {"grains.sintering.probability", "grains.sintering.grains"},
                                      {"grains.sintering.probability", "grains.sintering.mean_grain_mm"},
                                      {"grains.sintering.grains", "grains.sintering.mean_grain_mm"},
                                      {"base_color.sigma_s_mie_per_mm", "base_color.defect_concentration"}};

namespace names = recipe_names;

template <typename Enum>
Enum read_choice(TomlSection& section, const std::string& key, Enum fallback, const names::Names& allowed) {
    return names::value<Enum>(allowed, section.choice(key, names::name(allowed, fallback), allowed));
}

std::array<double, 3> read_direction(TomlSection& section, const std::string& key, const std::array<double, 3>& fallback) {
    const std::array<double, 3> direction = section.vector3(key, fallback, NumberRange::between(-1.0e9, 1.0e9));
    if (!(std::hypot(direction[0], direction[1], direction[2]) >= 1.0e-6))
        section.fail(key, "a direction of length 0 points nowhere; allowed: lengths from 0.000001");
    return direction;
}

std::filesystem::path read_needed_file(TomlSection& section, const std::string& whose) {
    const std::filesystem::path file = section.path("file");
    if (file.empty()) section.fail("file", whose + " needs a file");
    return file;
}

void read_bezier(TomlSection& section, ShapeRecipe& shape) {
    shape.patches = read_choice(section, "patches", shape.patches, names::patches);
    if (shape.patches == BezierPatches::teapot) {
        shape.longest_mm = section.number("longest_mm", shape.longest_mm, NumberRange::positive(1.0e7));
    } else {
        shape.size_mm = section.vector3("size_mm", shape.size_mm, NumberRange::positive(1.0e7), true);
        shape.girdle_mm =
            section.number("girdle_mm", std::round(0.25e6 * shape.size_mm[2]) / 1.0e6, NumberRange{0.0, shape.size_mm[2], true});
        if (shape.girdle_mm >= shape.size_mm[2]) section.fail("girdle_mm", "leaves no height for the dome above it");
    }
    shape.chord_error_mm = section.number("chord_error_mm", 0.0, NumberRange::from_zero(1.0e7));
}

ShapeRecipe read_shape(TomlSection section) {
    ShapeRecipe shape;
    if (!section.has("kind")) section.fail("kind", "is needed: the shape has no default");
    shape.kind = read_choice(section, "kind", shape.kind, names::shapes);
    if (shape.kind == ShapeKind::mesh) {
        shape.mesh_file = read_needed_file(section, "a mesh shape");
        shape.mesh_scale = section.number("scale", shape.mesh_scale, NumberRange::positive(1.0e9));
    } else if (shape.kind == ShapeKind::bezier) {
        read_bezier(section, shape);
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
                section.number("girdle_mm", std::round(0.15e6 * smallest) / 1.0e6, NumberRange{0.0, 0.9 * smallest, true});
        }
    }
    section.finish();
    return shape;
}

SitesRecipe read_sites(TomlSection section) {
    SitesRecipe sites;
    sites.kind = read_choice(section, "kind", sites.kind, names::sites);
    if (sites.kind == SiteKind::file) {
        sites.file = read_needed_file(section, "sites of kind file");
        sites.file_scale = section.number("scale", sites.file_scale, NumberRange::positive(1.0e9));
    } else {
        sites.region = read_choice(section, "region", sites.region, names::regions);
    }
    if (sites.kind == SiteKind::jittered_lattice)
        sites.jitter = section.number("jitter", sites.jitter, NumberRange::between(0.0, 1.0));
    section.finish();
    return sites;
}

WeightTerm read_weight_term(TomlSection section) {
    WeightTerm term;
    term.kind = read_choice(section, "kind", term.kind, names::weights);
    const bool from_file = term.kind == WeightKind::grid || term.kind == WeightKind::csv;
    term.amplitude =
        section.number("amplitude", from_file ? 1.0 : 0.5,
                       term.kind == WeightKind::none ? NumberRange::from_zero(100.0) : NumberRange::between(-1.0e6, 1.0e6));
    term.scale_mm = section.number("scale_mm", term.scale_mm, NumberRange::between(1.0e-6, 1.0e7));
    term.octaves = static_cast<int>(section.integer("octaves", term.octaves, 1, 16));
    if (term.kind == WeightKind::linear) term.direction = read_direction(section, "direction", term.direction);
    if (term.kind == WeightKind::radial)
        term.center_mm = section.vector3("center_mm", term.center_mm, NumberRange::between(-1.0e7, 1.0e7));
    if (from_file) term.file = read_needed_file(section, "a weight of kind " + names::name(names::weights, term.kind));
    if (term.kind == WeightKind::grid) term.grid = section.text("grid", "");
    section.finish();
    return term;
}

std::vector<WeightTerm> read_weight(TomlSection& grains) {
    if (!grains.is_array("weight")) return {read_weight_term(grains.section("weight"))};
    std::vector<WeightTerm> terms;
    for (TomlSection& section : grains.sections("weight")) terms.push_back(read_weight_term(section));
    if (terms.empty()) grains.fail("weight", "a sum needs at least one term; kind = \"none\" leaves weights out");
    return terms;
}

BoundaryNoiseRecipe read_boundary_noise(TomlSection section) {
    BoundaryNoiseRecipe noise;
    noise.amplitude_mm = section.number("amplitude_mm", noise.amplitude_mm, NumberRange::from_zero(1.0e7));
    noise.scale_mm = section.number("scale_mm", noise.scale_mm, NumberRange::between(1.0e-6, 1.0e7));
    noise.octaves = static_cast<int>(section.integer("octaves", noise.octaves, 1, 16));
    section.finish();
    return noise;
}

SinteringRecipe read_sintering(TomlSection section, const GrainsRecipe& grains) {
    SinteringRecipe sintering;
    sintering.graph = read_choice(section, "graph", sintering.graph, names::graphs);
    if (sintering.graph == SinteringGraph::lattice && grains.sites.kind != SiteKind::jittered_lattice)
        section.fail("graph", "the lattice graph needs sites = { kind = \"jittered-lattice\" }");
    int given = 0;
    for (const char* key : {"probability", "grains", "mean_grain_mm"}) {
        given += section.has(key) ? 1 : 0;
        if (given > 1) section.fail(key, "give one of probability, grains and mean_grain_mm");
    }
    sintering.probability = section.number("probability", sintering.probability, NumberRange::between(0.0, 1.0));
    sintering.target_grains = section.has("grains") ? section.integer("grains", 1, 1, grains.num_sites) : 0;
    sintering.mean_grain_mm =
        section.has("mean_grain_mm") ? section.number("mean_grain_mm", 1.0, NumberRange::positive(1.0e7)) : 0.0;
    sintering.preference = read_choice(section, "preference", sintering.preference, names::preferences);
    if (sintering.preference == BondPreference::misorientation)
        sintering.misorientation_deg =
            section.number("misorientation_deg", sintering.misorientation_deg, NumberRange{0.0, 180.0, true});
    if (sintering.preference == BondPreference::area && sintering.graph != SinteringGraph::apollonius)
        section.fail("preference", "contact areas are known to graph = \"apollonius\" alone");
    if (sintering.preference == BondPreference::area && grains.tessellation != TessellationKind::additive &&
        grains.tessellation != TessellationKind::voronoi)
        section.fail("preference", "contact areas are known to the additive and voronoi tessellations alone");
    section.finish();
    return sintering;
}

OrientationRecipe read_orientation(TomlSection section) {
    OrientationRecipe orientation;
    orientation.kind = read_choice(section, "kind", orientation.kind, names::orientations);
    if (orientation.kind == OrientationKind::fibre) {
        orientation.axis = read_direction(section, "axis", orientation.axis);
        orientation.lattice = read_direction(section, "lattice", orientation.lattice);
        orientation.spread_deg = section.number("spread_deg", orientation.spread_deg, NumberRange::between(0.0, 180.0));
    }
    if (orientation.kind == OrientationKind::table) orientation.file = read_needed_file(section, "orientations of kind table");
    section.finish();
    return orientation;
}

GrainsRecipe read_grains(TomlSection section, int& resolution) {
    GrainsRecipe grains;
    grains.sites = read_sites(section.section("sites"));
    if (grains.sites.kind == SiteKind::file && section.has("num_sites"))
        section.fail("num_sites", "the sites come from a file, which says how many there are");
    grains.num_sites = section.integer("num_sites", grains.num_sites, 1, max_sites);
    if (grains.sites.kind == SiteKind::file) grains.num_sites = max_sites;
    if (section.has("voxel_size_mm") && section.has("resolution"))
        section.fail("resolution", "give either voxel_size_mm or resolution, not both");
    grains.voxel_size_mm = section.number("voxel_size_mm", 0.0, NumberRange{1.5e-5, 1.0e6, false});
    resolution = static_cast<int>(section.integer("resolution", section.has("voxel_size_mm") ? 0 : 256, 4, 16384));
    grains.seed = static_cast<std::uint64_t>(section.integer("seed", 1, 0, INT64_MAX));
    grains.tessellation = read_choice(section, "tessellation", grains.tessellation, names::tessellations);
    grains.weight = read_weight(section);
    grains.limit_weights = section.boolean("limit_weights", grains.limit_weights);
    grains.boundary_noise = read_boundary_noise(section.section("boundary_noise"));
    grains.sintering = read_sintering(section.section("sintering"), grains);
    grains.orientation = read_orientation(section.section("orientation"));
    if (grains.orientation.kind == OrientationKind::table && grains.sintering.preference == BondPreference::misorientation)
        section.fail("orientation",
                     "a table orients finished grains; preference = \"misorientation\" needs sites that have "
                     "orientations before: kind \"uniform\" or \"fibre\"");
    section.finish();
    return grains;
}

RefractiveIndex read_index(TomlSection& section, const std::string& key, const RefractiveIndex& fallback) {
    if (!section.is_text(key)) return section.number(key, fallback.at(sodium_d_nm), NumberRange::between(1.0, 4.0));
    const std::string name = section.text(key, "");
    if (name.ends_with(".csv")) return RefractiveIndex::from_csv(section.path(key));
    try {
        return RefractiveIndex::of_material(name);
    } catch (const InputError& error) {
        section.fail(key, error.what());
    }
}

CrystalRecipe read_crystal(TomlSection section) {
    CrystalRecipe crystal;
    crystal.sphere_diameter_nm =
        section.number("sphere_diameter_nm", crystal.sphere_diameter_nm, NumberRange::between(50.0, 1000.0));
    crystal.n_sphere = read_index(section, "n_sphere", crystal.n_sphere);
    crystal.n_medium = read_index(section, "n_medium", crystal.n_medium);
    crystal.coherence_length_um =
        section.number("coherence_length_um", crystal.coherence_length_um, NumberRange::between(0.5, 1.0e4));
    crystal.stacking_fault_probability = section.number("stacking_fault_probability", 0.0, NumberRange::between(0.0, 1.0));
    crystal.mosaic_spread_deg = section.number("mosaic_spread_deg", 0.0, NumberRange::between(0.0, 30.0));
    section.finish();
    return crystal;
}

FieldRecipe read_field(TomlSection section) {
    FieldRecipe field;
    field.kind = read_choice(section, "kind", section.has("kind") ? field.kind : FieldKind::constant, names::fields);
    if (field.kind == FieldKind::grid) {
        field.file = read_needed_file(section, "a field of kind grid");
        field.grid = section.text("grid", "");
    } else if (field.kind != FieldKind::constant) {
        field.contrast = section.number("contrast", field.contrast, NumberRange::between(0.0, 1.0));
    }
    if (field.kind == FieldKind::noise || field.kind == FieldKind::layers)
        field.scale_mm = section.number("scale_mm", field.scale_mm, NumberRange::between(1.0e-6, 1.0e7));
    if (field.kind == FieldKind::noise) field.octaves = static_cast<int>(section.integer("octaves", field.octaves, 1, 16));
    if (field.kind == FieldKind::layers) field.direction = read_direction(section, "direction", field.direction);
    if (field.kind != FieldKind::constant)
        field.voxel_size_mm = section.number("voxel_size_mm", 0.0, NumberRange::from_zero(1.0e6));
    section.finish();
    return field;
}

BaseColorRecipe read_base_color(TomlSection section) {
    const NumberRange coefficient = NumberRange::from_zero(1.0e6);
    BaseColorRecipe color;
    color.absorber = section.text("absorber", color.absorber);
    if (color.absorber.ends_with(".csv")) color.absorber = section.path("absorber").string();
    color.sigma_a_per_mm = section.number("sigma_a_per_mm", color.sigma_a_per_mm, coefficient);
    color.sigma_a_reference_nm = section.number("sigma_a_reference_nm", color.sigma_a_reference_nm,
                                                NumberRange::between(units::wavelength_min_nm, units::wavelength_max_nm));
    color.sigma_s_rayleigh_400nm_per_mm = section.number("sigma_s_rayleigh_400nm_per_mm", 0.0, coefficient);
    color.sigma_s_mie_per_mm = section.number("sigma_s_mie_per_mm", 0.0, coefficient);
    color.mie_phase = read_choice(section, "mie_phase", color.mie_phase, names::mie_phases);
    color.draine_alpha = section.number("draine_alpha", color.draine_alpha, NumberRange::between(0.0, 1.0e3));
    color.mie_particle = read_choice(section, "mie_particle", color.mie_particle, names::mie_particles);
    color.mie_particle_diameter_nm = section.number("mie_particle_diameter_nm", 0.0, NumberRange::from_zero(1.0e4));
    if (color.mie_particle_diameter_nm > 0.0 && color.mie_particle_diameter_nm < 1.0)
        section.fail("mie_particle_diameter_nm", "is out of range; allowed: 0 (as large as the crystal's spheres) or 1 to 10000");
    color.defect_concentration = section.number("defect_concentration", 0.0, NumberRange::between(0.0, 0.2));
    if (color.defect_concentration > 0.0 && section.has("sigma_s_mie_per_mm"))
        section.fail("defect_concentration", "sigma_s_mie_per_mm follows from it: give one of the two");
    color.mie_asymmetry = section.number("mie_asymmetry", color.mie_asymmetry, NumberRange::between(-0.99, 0.99));
    color.sigma_a_field = read_field(section.section("sigma_a_field"));
    color.sigma_s_rayleigh_field = read_field(section.section("sigma_s_rayleigh_field"));
    color.sigma_s_mie_field = read_field(section.section("sigma_s_mie_field"));
    section.finish();
    return color;
}

OutputRecipe read_output(TomlSection section) {
    OutputRecipe output;
    if (section.has("grids")) {
        output.grids.clear();
        for (const std::string& name : section.choices("grids", names::grids))
            output.grids.push_back(names::value<OutputGrid>(names::grids, name));
        std::sort(output.grids.begin(), output.grids.end());
        output.grids.erase(std::unique(output.grids.begin(), output.grids.end()), output.grids.end());
        if (!output.has(OutputGrid::grain_id) && !output.has(OutputGrid::sites))
            section.fail("grids", "a file needs grain_id or sites to hold an opal");
    }
    output.for_blender = section.boolean("for_blender", output.for_blender);
    section.finish();
    return output;
}

Recipe read_document(const TomlDocument& document) {
    Recipe recipe;
    TomlSection root = document.root();
    if (!root.has("shape")) root.fail("shape", "is needed: a [shape] table with a kind");
    recipe.shape = read_shape(root.section("shape"));
    recipe.grains = read_grains(root.section("grains"), recipe.resolution);
    recipe.crystal = read_crystal(root.section("crystal"));
    recipe.base_color = read_base_color(root.section("base_color"));
    recipe.output = read_output(root.section("output"));
    root.finish();
    return recipe;
}

}  // namespace

Recipe read_recipe(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    return read_document(TomlDocument(file, overrides, exclusive_keys));
}

Recipe parse_recipe(const std::string& text, const std::string& name, const std::vector<std::string>& overrides) {
    return read_document(TomlDocument(text, name, overrides, exclusive_keys));
}

bool OutputRecipe::has(OutputGrid grid) const {
    return std::find(grids.begin(), grids.end(), grid) != grids.end();
}

}  // namespace opal
