// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "formats/crystal_defect.h"
#include "formats/field_summary.h"
#include "formats/recipe_names.h"
#include "formats/text.h"
#include "formats/units.h"
#include "modeler/build_report.h"

namespace opal {
namespace {

nlohmann::json index_name(const RefractiveIndex& index) {
    return index.varies() ? nlohmann::json(index.name()) : nlohmann::json();
}

/// What the Mie part of the scattering is: its phase function, its particle where that gives it, and its spectrum.
nlohmann::json describe_scatterers(const OpalConstants& constants) {
    const CrystalDefect defect = crystal_defect(constants);
    const auto sigma_per_mm = [&](double wavelength_nm) {
        const SampledSpectrum& shape = constants.sigma_s_mie_shape;
        return constants.sigma_s_mie_per_mm * (shape.value.empty() ? 1.0 : shape.at(wavelength_nm));
    };
    nlohmann::json scatterers = {{"phase", recipe_names::name(recipe_names::mie_phases, constants.mie_phase)},
                                 {"asymmetry", constants.mie_asymmetry},
                                 {"draine_alpha", constants.draine_alpha},
                                 {"particle", recipe_names::name(recipe_names::mie_particles, constants.mie_particle)},
                                 {"particle_diameter_nm", defect.diameter_nm},
                                 {"follows_from_defects", !constants.sigma_s_mie_shape.value.empty()},
                                 {"sigma_s_450nm_per_mm", sigma_per_mm(450.0)},
                                 {"sigma_s_550nm_per_mm", sigma_per_mm(550.0)},
                                 {"sigma_s_650nm_per_mm", sigma_per_mm(650.0)}};
    if (constants.mie_phase == MiePhase::lorenz_mie)
        scatterers["asymmetry"] =
            mie_efficiencies(mie_coefficients(defect.size_parameter(550.0), defect.relative_index(550.0))).asymmetry;
    return scatterers;
}

nlohmann::json describe_constants(const OpalConstants& constants) {
    const double n_eff = crystal_defect(constants).effective_index(sodium_d_nm);
    return {{"sphere_diameter_nm", constants.sphere_diameter_nm},
            {"n_sphere", constants.n_sphere.at(sodium_d_nm)},
            {"n_medium", constants.n_medium.at(sodium_d_nm)},
            {"n_sphere_material", index_name(constants.n_sphere)},
            {"n_medium_material", index_name(constants.n_medium)},
            {"n_eff", n_eff},
            {"wavelength_111_normal_nm", 2.0 * n_eff * constants.sphere_diameter_nm * std::sqrt(2.0 / 3.0)},
            {"coherence_length_um", constants.coherence_length_um},
            {"absorber", constants.absorber},
            {"sigma_a_550nm_per_mm", constants.sigma_a_per_mm.at(550.0)},
            {"sigma_s_rayleigh_400nm_per_mm", constants.sigma_s_rayleigh_400nm_per_mm},
            {"sigma_s_mie_per_mm", constants.sigma_s_mie_per_mm},
            {"mie_asymmetry", constants.mie_asymmetry},
            {"mie", describe_scatterers(constants)},
            {"stacking_fault_probability", constants.stacking_fault_probability},
            {"mosaic_spread_deg", constants.mosaic_spread_deg}};
}

std::string index_text(const nlohmann::json& index, const nlohmann::json& material) {
    const std::string value = fmt::format("{:.5g}", index.get<double>());
    return material.is_null() ? value : fmt::format("{} ({})", value, material.get<std::string>());
}

std::string scatterers_text(const nlohmann::json& mie) {
    const auto number = [&](const char* key) { return mie[key].get<double>(); };
    const std::string phase = mie["phase"].get<std::string>();
    std::string text = fmt::format("scatterers  {}, mean cosine {:.3g}", phase, number("asymmetry"));
    if (phase == "lorenz-mie") text += " at 550 nm";
    if (phase == "draine") text += fmt::format(", alpha {:.4g}", number("draine_alpha"));
    if (phase == "lorenz-mie" || mie["follows_from_defects"].get<bool>())
        text +=
            fmt::format("; particle: {}, {:.4g} nm across", mie["particle"].get<std::string>(), number("particle_diameter_nm"));
    if (mie["follows_from_defects"].get<bool>())
        text += fmt::format(
            "\ndefects     scatter {:.4g} /mm at 450 nm, {:.4g} /mm at 550 nm, {:.4g} /mm at 650 nm (the Mie part of the body)",
            number("sigma_s_450nm_per_mm"), number("sigma_s_550nm_per_mm"), number("sigma_s_650nm_per_mm"));
    return text + "\n";
}

nlohmann::json vector_json(const openvdb::Vec3d& v) {
    return {v.x(), v.y(), v.z()};
}

/// Sizes in mm; null where a file of sites alone does not tell.
nlohmann::json describe_voxels(const OpalAsset& asset) {
    if (!asset.grain_id)
        return {{"size_mm", nullptr},
                {"lowest_corner_mm", nullptr},
                {"volume_mm3", nullptr},
                {"voxel_size_mm", nullptr},
                {"voxels", 0},
                {"leaves", 0},
                {"mean_grain_diameter_mm", nullptr}};
    const openvdb::Int32Grid& grain_id = *asset.grain_id;
    const openvdb::Vec3d voxel_mm = grain_id.voxelSize();
    const openvdb::CoordBBox voxels = grain_id.evalActiveVoxelBoundingBox();
    const auto active = grain_id.activeVoxelCount();
    return {{"size_mm", vector_json(voxels.extents().asVec3d() * voxel_mm)},
            {"lowest_corner_mm", vector_json(grain_id.indexToWorld(voxels.min().asVec3d() - openvdb::Vec3d(0.5)))},
            {"volume_mm3", static_cast<double>(active) * voxel_mm.product()},
            {"voxel_size_mm", voxel_mm.x()},
            {"voxels", active},
            {"leaves", grain_id.tree().leafCount()},
            {"mean_grain_diameter_mm", mean_grain_diameter_mm(asset)}};
}

std::vector<std::string> grids_in(const OpalAsset& asset) {
    const std::pair<const char*, bool> grids[] = {{grid_names::grain_id, asset.grain_id != nullptr},
                                                  {grid_names::shape, asset.shape != nullptr},
                                                  {grid_names::weight, asset.weight != nullptr},
                                                  {grid_names::sigma_a_scale, asset.sigma_a_scale != nullptr},
                                                  {grid_names::sigma_s_rayleigh, asset.sigma_s_rayleigh_400nm != nullptr},
                                                  {grid_names::sigma_s_mie, asset.sigma_s_mie != nullptr},
                                                  {grid_names::sites, !asset.sites.empty()}};
    std::vector<std::string> names;
    for (const auto& [name, there] : grids)
        if (there) names.push_back(name);
    return names;
}

/// Smallest, largest and mean value of each coefficient that varies.
nlohmann::json describe_fields(const OpalAsset& asset) {
    nlohmann::json fields = nlohmann::json::object();
    for (const auto& [name, field] : varying_coefficients(asset)) {
        const FieldSummary summary = summarize_field(*field, asset.shape);
        fields[name] = {{"min", summary.min},
                        {"mean", summary.mean},
                        {"max", summary.max},
                        {"voxel_size_mm", field->voxelSize().x()},
                        {"voxels", field->activeVoxelCount()}};
    }
    return fields;
}

std::string fields_text(const nlohmann::json& fields) {
    std::string text;
    for (const auto& [name, field] : fields.items())
        text += fmt::format("field       {}: {:.4g} to {:.4g}, {:.4g} on average; {} voxels of {:.4g} mm\n", name,
                            field["min"].get<double>(), field["max"].get<double>(), field["mean"].get<double>(),
                            field["voxels"].get<std::uint64_t>(), field["voxel_size_mm"].get<double>());
    return text;
}

std::string size_text(const nlohmann::json& d) {
    if (d["size_mm"].is_null()) return "size        not known: sites alone, no voxels\n";
    const auto number = [](const nlohmann::json& value) { return value.get<double>(); };
    std::string text = fmt::format("size        {:.4g} x {:.4g} x {:.4g} mm, {:.4g} mm^3\nextent     ", number(d["size_mm"][0]),
                                   number(d["size_mm"][1]), number(d["size_mm"][2]), number(d["volume_mm3"]));
    for (int axis = 0; axis < 3; ++axis) {
        const double low_mm = number(d["lowest_corner_mm"][axis]);
        text += fmt::format(" {} {:.4g} to {:.4g}{}", "xyz"[axis], low_mm, low_mm + number(d["size_mm"][axis]),
                            axis < 2 ? "," : " mm\n");
    }
    return text + fmt::format("voxels      {} of {:.4g} mm, in {} leaves\n", d["voxels"].get<std::uint64_t>(),
                              number(d["voxel_size_mm"]), d["leaves"].get<std::uint64_t>());
}

std::string tessellation_text(const nlohmann::json& tessellation) {
    const double amplitude_mm = tessellation["boundary_noise_amplitude_mm"].get<double>();
    const std::string noise = amplitude_mm > 0.0
                                  ? fmt::format("; boundaries displaced by up to {:.4g} mm, features of {:.4g} mm, {} octaves",
                                                amplitude_mm, tessellation["boundary_noise_scale_mm"].get<double>(),
                                                tessellation["boundary_noise_octaves"].get<int>())
                                  : std::string();
    return fmt::format("cells       {}{}\n", tessellation["kind"].get<std::string>(), noise);
}

}  // namespace

nlohmann::json describe_opal(const OpalAsset& asset) {
    const auto hidden = std::count_if(asset.sites.begin(), asset.sites.end(), [](const Site& site) { return site.grain == 0; });
    nlohmann::json description = describe_voxels(asset);
    description["grids"] = grids_in(asset);
    description["sites"] = asset.sites.size();
    description["hidden_sites"] = hidden;
    description["grains"] = asset.num_grains();
    description["tessellation"] = {{"kind", recipe_names::name(recipe_names::tessellations, asset.tessellation)},
                                   {"boundary_noise_amplitude_mm", asset.boundary_noise.amplitude_mm},
                                   {"boundary_noise_scale_mm", asset.boundary_noise.scale_mm},
                                   {"boundary_noise_octaves", asset.boundary_noise.octaves}};
    description["constants"] = describe_constants(asset.constants);
    description["fields"] = describe_fields(asset);
    description["seed"] = asset.seed;
    description["program_version"] = asset.program_version;
    description["schema_version"] = asset.schema_version;
    description["recipe"] = asset.recipe_toml;
    return description;
}

std::string opal_info_text(const nlohmann::json& d) {
    const nlohmann::json& c = d["constants"];
    const auto number = [](const nlohmann::json& value) { return value.get<double>(); };
    std::string text = size_text(d);
    text += fmt::format("grids       {}\n", join(d["grids"].get<std::vector<std::string>>()));
    text += fmt::format("grains      {}{}\n", d["grains"].get<std::uint64_t>(),
                        d["mean_grain_diameter_mm"].is_null()
                            ? std::string()
                            : fmt::format(", {:.3g} mm across on average", number(d["mean_grain_diameter_mm"])));
    text += fmt::format("sites       {} ({} hidden)\n", d["sites"].get<std::uint64_t>(), d["hidden_sites"].get<std::uint64_t>());
    text += tessellation_text(d["tessellation"]);
    text += fmt::format("spheres     {:.4g} nm across, index {} in {}: effective index {:.5g}\n", number(c["sphere_diameter_nm"]),
                        index_text(c["n_sphere"], c["n_sphere_material"]), index_text(c["n_medium"], c["n_medium_material"]),
                        number(c["n_eff"]));
    text += fmt::format("color       up to {:.1f} nm, from light straight onto (111) planes; coherence length {:.4g} um\n",
                        number(c["wavelength_111_normal_nm"]), number(c["coherence_length_um"]));
    text += fmt::format(
        "body        absorber {}, {:.4g} /mm at 550 nm; scattering {:.4g} /mm (Rayleigh, 400 nm) and {:.4g} /mm (Mie)\n",
        c["absorber"].get<std::string>(), number(c["sigma_a_550nm_per_mm"]), number(c["sigma_s_rayleigh_400nm_per_mm"]),
        number(c["sigma_s_mie_per_mm"]));
    text += scatterers_text(c["mie"]);
    text += fields_text(d["fields"]);
    text += fmt::format("disorder    stacking faults {:.4g} per layer, mosaic spread {:.4g} degrees\n",
                        number(c["stacking_fault_probability"]), number(c["mosaic_spread_deg"]));
    const std::string version = d["program_version"].get<std::string>();
    text += d["schema_version"].get<int>() == 0 ? std::string("made by     another program\n")
                                                : fmt::format("made by     opal {}, schema {}, seed {}\n", version,
                                                              d["schema_version"].get<int>(), d["seed"].get<std::uint64_t>());
    const std::string recipe = d["recipe"].get<std::string>();
    if (!recipe.empty()) text += "recipe\n" + recipe;
    return text;
}

}  // namespace opal
