// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "formats/text.h"
#include "formats/units.h"
#include "modeler/build_report.h"

namespace opal {
namespace {

/// Part of space that touching spheres fill in fcc packing.
const double fcc_fill = units::pi / (3.0 * std::sqrt(2.0));

nlohmann::json describe_constants(const OpalConstants& constants) {
    const double n_eff = fcc_fill * constants.n_sphere + (1.0 - fcc_fill) * constants.n_medium;
    return {{"sphere_diameter_nm", constants.sphere_diameter_nm},
            {"n_sphere", constants.n_sphere},
            {"n_medium", constants.n_medium},
            {"n_eff", n_eff},
            {"wavelength_111_normal_nm", 2.0 * n_eff * constants.sphere_diameter_nm * std::sqrt(2.0 / 3.0)},
            {"coherence_length_um", constants.coherence_length_um},
            {"absorber", constants.absorber},
            {"sigma_a_550nm_per_mm", constants.sigma_a_per_mm.at(550.0)},
            {"sigma_s_rayleigh_400nm_per_mm", constants.sigma_s_rayleigh_400nm_per_mm},
            {"sigma_s_mie_per_mm", constants.sigma_s_mie_per_mm},
            {"mie_asymmetry", constants.mie_asymmetry}};
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

}  // namespace

nlohmann::json describe_opal(const OpalAsset& asset) {
    const openvdb::Vec3d voxel_mm = asset.grain_id->voxelSize();
    const openvdb::CoordBBox voxels = asset.grain_id->evalActiveVoxelBoundingBox();
    const openvdb::Vec3d size_mm = voxels.extents().asVec3d() * voxel_mm;
    const openvdb::Vec3d low_mm = asset.grain_id->indexToWorld(voxels.min().asVec3d() - openvdb::Vec3d(0.5));
    const auto active = asset.grain_id->activeVoxelCount();
    const auto hidden = std::count_if(asset.sites.begin(), asset.sites.end(), [](const Site& site) { return site.grain == 0; });
    return {{"size_mm", {size_mm.x(), size_mm.y(), size_mm.z()}},
            {"lowest_corner_mm", {low_mm.x(), low_mm.y(), low_mm.z()}},
            {"volume_mm3", static_cast<double>(active) * asset.grain_id->voxelSize().product()},
            {"grids", grids_in(asset)},
            {"voxel_size_mm", voxel_mm.x()},
            {"voxels", active},
            {"leaves", asset.grain_id->tree().leafCount()},
            {"sites", asset.sites.size()},
            {"hidden_sites", hidden},
            {"grains", asset.num_grains()},
            {"mean_grain_diameter_mm", mean_grain_diameter_mm(asset)},
            {"constants", describe_constants(asset.constants)},
            {"seed", asset.seed},
            {"program_version", asset.program_version},
            {"schema_version", asset.schema_version},
            {"recipe", asset.recipe_toml}};
}

std::string opal_info_text(const nlohmann::json& d) {
    const nlohmann::json& c = d["constants"];
    const auto number = [](const nlohmann::json& value) { return value.get<double>(); };
    std::string text = fmt::format("size        {:.4g} x {:.4g} x {:.4g} mm, {:.4g} mm^3\n", number(d["size_mm"][0]),
                                   number(d["size_mm"][1]), number(d["size_mm"][2]), number(d["volume_mm3"]));
    text += "extent     ";
    for (int axis = 0; axis < 3; ++axis) {
        const double low_mm = number(d["lowest_corner_mm"][axis]);
        text += fmt::format(" {} {:.4g} to {:.4g}{}", "xyz"[axis], low_mm, low_mm + number(d["size_mm"][axis]),
                            axis < 2 ? "," : " mm\n");
    }
    text += fmt::format("grids       {}\n", join(d["grids"].get<std::vector<std::string>>()));
    text += fmt::format("voxels      {} of {:.4g} mm, in {} leaves\n", d["voxels"].get<std::uint64_t>(),
                        number(d["voxel_size_mm"]), d["leaves"].get<std::uint64_t>());
    text += fmt::format("grains      {}, {:.3g} mm across on average\n", d["grains"].get<std::uint64_t>(),
                        number(d["mean_grain_diameter_mm"]));
    text += fmt::format("sites       {} ({} hidden)\n", d["sites"].get<std::uint64_t>(), d["hidden_sites"].get<std::uint64_t>());
    text += fmt::format("spheres     {:.4g} nm across, index {:.5g} in {:.5g}: effective index {:.5g}\n",
                        number(c["sphere_diameter_nm"]), number(c["n_sphere"]), number(c["n_medium"]), number(c["n_eff"]));
    text += fmt::format("color       up to {:.1f} nm, from light straight onto (111) planes; coherence length {:.4g} um\n",
                        number(c["wavelength_111_normal_nm"]), number(c["coherence_length_um"]));
    text += fmt::format(
        "body        absorber {}, {:.4g} /mm at 550 nm; scattering {:.4g} /mm (Rayleigh, 400 nm) and {:.4g} /mm (Mie)\n",
        c["absorber"].get<std::string>(), number(c["sigma_a_550nm_per_mm"]), number(c["sigma_s_rayleigh_400nm_per_mm"]),
        number(c["sigma_s_mie_per_mm"]));
    const std::string version = d["program_version"].get<std::string>();
    text += d["schema_version"].get<int>() == 0 ? std::string("made by     another program\n")
                                                : fmt::format("made by     opal {}, schema {}, seed {}\n", version,
                                                              d["schema_version"].get<int>(), d["seed"].get<std::uint64_t>());
    const std::string recipe = d["recipe"].get<std::string>();
    if (!recipe.empty()) text += "recipe\n" + recipe;
    return text;
}

}  // namespace opal
