// SPDX-License-Identifier: Apache-2.0
#include "formats/scene_objects.h"

#include <fmt/format.h>

#include <algorithm>

#include "formats/error.h"
#include "formats/metals.h"
#include "formats/spectrum.h"
#include "formats/text.h"
#include "formats/toml_enum.h"
#include "formats/units.h"

namespace opal {
namespace {

const std::vector<std::string> material_names = {"diffuse", "dielectric", "conductor", "plastic"};
const std::vector<std::string> object_names = {"opal", "mesh", "plane", "sphere", "cylinder"};

/// 0, or what rough surfaces resolve.
double read_roughness(TomlSection& section) {
    const double roughness = section.number("roughness", 0.0, NumberRange::between(0.0, 1.0));
    if (roughness > 0.0 && roughness < min_scene_roughness)
        section.fail("roughness",
                     fmt::format("{:g} is out of range; allowed: 0 (smooth) or {} to 1", roughness, min_scene_roughness));
    return roughness;
}

/// A built-in name or a .csv's path, checked by `check`, which throws InputError.
template <typename Check>
std::string name_or_csv(TomlSection& section, const std::string& key, const std::string& fallback, const Check& check) {
    std::string name = section.text(key, fallback);
    if (name.ends_with(".csv")) return section.path(key).string();
    try {
        check(name);
    } catch (const InputError& error) {
        section.fail(key, error.what());
    }
    return name;
}

RefractiveIndex read_index(TomlSection& section, const std::string& key, const RefractiveIndex& fallback) {
    if (!section.is_text(key)) return section.number(key, fallback.at(sodium_d_nm), NumberRange::between(1.0, 4.0));
    const std::string name = name_or_csv(section, key, "", RefractiveIndex::of_material);
    return name.ends_with(".csv") ? RefractiveIndex::from_csv(name) : RefractiveIndex::of_material(name);
}

MediumDescription read_medium(TomlSection section) {
    const NumberRange coefficient = NumberRange::from_zero(1.0e6);
    MediumDescription medium;
    medium.absorber = name_or_csv(section, "absorber", medium.absorber, builtin_absorber);
    medium.sigma_a_per_mm = section.number("sigma_a_per_mm", medium.sigma_a_per_mm, coefficient);
    medium.sigma_a_reference_nm = section.number("sigma_a_reference_nm", medium.sigma_a_reference_nm,
                                                 NumberRange::between(units::wavelength_min_nm, units::wavelength_max_nm));
    medium.sigma_s_per_mm = section.number("sigma_s_per_mm", medium.sigma_s_per_mm, coefficient);
    medium.asymmetry = section.number("asymmetry", medium.asymmetry, NumberRange::between(-0.99, 0.99));
    medium.density_file = section.path("density_file");
    if (!medium.density_file.empty()) {
        medium.density_grid = section.text("density_grid", "");
        medium.density_scale = section.number("density_scale", medium.density_scale, NumberRange::from_zero(1.0e6));
    }
    section.finish();
    return medium;
}

std::string medium_to_toml(const MediumDescription& medium) {
    std::string text = fmt::format(
        "medium.absorber = {}\nmedium.sigma_a_per_mm = {}\nmedium.sigma_a_reference_nm = {}\nmedium.sigma_s_per_mm = {}\n"
        "medium.asymmetry = {}\n",
        toml_quoted(medium.absorber), medium.sigma_a_per_mm, medium.sigma_a_reference_nm, medium.sigma_s_per_mm,
        medium.asymmetry);
    if (!medium.density_file.empty())
        text += fmt::format("medium.density_file = {}\nmedium.density_grid = {}\nmedium.density_scale = {}\n",
                            toml_quoted(medium.density_file.string()), toml_quoted(medium.density_grid), medium.density_scale);
    return text;
}

std::string index_to_toml(const RefractiveIndex& index) {
    return index.varies() ? toml_quoted(index.name()) : fmt::format("{}", index.at(sodium_d_nm));
}

void read_shape(TomlSection& section, ObjectDescription& object) {
    const NumberRange length = NumberRange::positive(1.0e7);
    if (object.kind == ObjectKind::sphere || object.kind == ObjectKind::cylinder)
        object.radius_mm = section.number("radius_mm", object.radius_mm, length);
    if (object.kind == ObjectKind::cylinder) {
        object.height_mm = section.number("height_mm", object.height_mm, length);
        const double largest = std::min(object.radius_mm, object.height_mm);
        object.bevel_mm = section.number("bevel_mm", std::min(object.bevel_mm, 0.5 * largest), NumberRange::from_zero(largest));
    }
    if (object.kind == ObjectKind::plane) object.size_mm = section.number("size_mm", object.size_mm, length);
    if (object.kind == ObjectKind::mesh && section.has("smooth_normals_deg"))
        object.smooth_normals_deg = section.number("smooth_normals_deg", 0.0, NumberRange::between(0.0, 180.0));
}

}  // namespace

MaterialDescription read_material(TomlSection section) {
    MaterialDescription material;
    material.name = section.text("name", "");
    if (material.name.empty()) section.fail("name", "is needed: objects refer to a material by its name");
    material.kind = enum_choice(section, "kind", material.kind, material_names);
    if (material.kind == MaterialKind::diffuse || material.kind == MaterialKind::plastic)
        material.albedo = section.vector3("albedo", material.albedo, NumberRange::between(0.0, 1.0), true);
    if (material.kind == MaterialKind::dielectric || material.kind == MaterialKind::plastic)
        material.n = read_index(section, "n", material.n);
    if (material.kind != MaterialKind::diffuse) material.roughness = read_roughness(section);
    if (material.kind == MaterialKind::conductor)
        material.metal = name_or_csv(section, "metal", material.metal, MetalIndex::of_metal);
    if (material.kind == MaterialKind::dielectric) material.medium = read_medium(section.section("medium"));
    section.finish();
    return material;
}

std::string material_to_toml(const MaterialDescription& material) {
    std::string text = fmt::format("\n[[material]]\nname = {}\nkind = \"{}\"\n", toml_quoted(material.name),
                                   material_names[static_cast<std::size_t>(material.kind)]);
    if (material.kind == MaterialKind::diffuse || material.kind == MaterialKind::plastic)
        text += fmt::format("albedo = {}\n", vector_text(material.albedo));
    if (material.kind == MaterialKind::dielectric || material.kind == MaterialKind::plastic)
        text += fmt::format("n = {}\n", index_to_toml(material.n));
    if (material.kind != MaterialKind::diffuse) text += fmt::format("roughness = {}\n", material.roughness);
    if (material.kind == MaterialKind::conductor) text += fmt::format("metal = {}\n", toml_quoted(material.metal));
    if (material.kind == MaterialKind::dielectric) text += medium_to_toml(material.medium);
    return text;
}

ObjectDescription read_object(TomlSection section, const std::vector<MaterialDescription>& materials) {
    ObjectDescription object;
    if (!section.has("kind")) section.fail("kind", "is needed; allowed: " + join(object_names));
    object.kind = enum_choice(section, "kind", object.kind, object_names);
    object.name = section.text("name", "");
    if (object.kind == ObjectKind::opal || object.kind == ObjectKind::mesh) {
        object.file = section.path("file");
        if (object.file.empty()) section.fail("file", "is needed for this kind of object");
    }
    bool transparent = object.kind == ObjectKind::opal;
    if (object.kind == ObjectKind::opal) {
        object.orientation_seed = static_cast<std::uint64_t>(section.integer("orientation_seed", 1, 0, INT64_MAX));
        object.roughness = read_roughness(section);
        object.exact = section.boolean("exact", object.exact);
    } else {
        if (!section.has("material")) section.fail("material", "is needed: the name of a [[material]]");
        std::vector<std::string> names;
        for (const MaterialDescription& material : materials) names.push_back(material.name);
        object.material = section.choice("material", "", names);
        const auto place = std::find(names.begin(), names.end(), object.material) - names.begin();
        transparent = materials[std::size_t(place)].kind == MaterialKind::dielectric;
        if (transparent && object.kind == ObjectKind::plane)
            section.fail("material", "'" + object.material + "' is a dielectric, which fills a body; a plane encloses nothing");
    }
    if (transparent) object.priority = static_cast<int>(section.integer("priority", 0, -1000, 1000));
    read_shape(section, object);
    object.translate_mm = section.vector3("translate_mm", object.translate_mm, NumberRange::between(-1.0e7, 1.0e7));
    object.rotate_deg = section.vector3("rotate_deg", object.rotate_deg, NumberRange::between(-3.6e4, 3.6e4));
    object.scale = section.number("scale", object.scale, NumberRange::between(1.0e-4, 1.0e6));
    section.finish();
    return object;
}

std::string object_to_toml(const ObjectDescription& object) {
    std::string text = fmt::format("\n[[object]]\nkind = \"{}\"\n", object_names[static_cast<std::size_t>(object.kind)]);
    if (!object.name.empty()) text += fmt::format("name = {}\n", toml_quoted(object.name));
    if (!object.file.empty()) text += fmt::format("file = {}\n", toml_quoted(object.file.string()));
    if (object.kind == ObjectKind::opal)
        text += fmt::format("orientation_seed = {}\nroughness = {}\nexact = {}\npriority = {}\n", object.orientation_seed,
                            object.roughness, object.exact, object.priority);
    if (!object.material.empty()) text += fmt::format("material = {}\n", toml_quoted(object.material));
    if (object.kind != ObjectKind::opal && object.priority != 0) text += fmt::format("priority = {}\n", object.priority);
    if (object.kind == ObjectKind::sphere || object.kind == ObjectKind::cylinder)
        text += fmt::format("radius_mm = {}\n", object.radius_mm);
    if (object.kind == ObjectKind::cylinder)
        text += fmt::format("height_mm = {}\nbevel_mm = {}\n", object.height_mm, object.bevel_mm);
    if (object.kind == ObjectKind::plane) text += fmt::format("size_mm = {}\n", object.size_mm);
    if (object.smooth_normals_deg) text += fmt::format("smooth_normals_deg = {}\n", *object.smooth_normals_deg);
    return text + fmt::format("translate_mm = {}\nrotate_deg = {}\nscale = {}\n", vector_text(object.translate_mm),
                              vector_text(object.rotate_deg), object.scale);
}

}  // namespace opal
