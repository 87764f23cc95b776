// SPDX-License-Identifier: GPL-3.0-or-later
#include "variants.h"

#include <fmt/format.h>

#include <cmath>

#include "formats/crystal_defect.h"
#include "formats/lorenz_mie.h"
#include "formats/quality.h"
#include "formats/units.h"

namespace opal {
namespace {

using Variants = std::vector<ParetoVariant>;

/// A surface and grains without voxels, whatever the voxels of the surface.
const std::string only_cells = "output.grids=[\"shape\", \"sites\", \"fields\"]";

std::string voxels_along(const ParetoScene& scene, int count) {
    return fmt::format("grains.voxel_size_mm={}", scene.longest_mm / count);
}

Variants resolutions(const ParetoScene& scene, bool quick) {
    Variants variants;
    const std::vector<int> counts = quick ? std::vector<int>{32, 128} : std::vector<int>{32, 64, 128, 256, 512};
    for (const int count : counts) {
        variants.push_back(
            {"resolution", fmt::format("cells, surface of {}", count), {voxels_along(scene, count), only_cells}, {}});
        variants.back().exact = count == counts.back();
        variants.push_back({"resolution", fmt::format("voxels {}", count), {voxels_along(scene, count)}, {"opal.grains=voxels"}});
    }
    return variants;
}

Variants modelled_for_the_picture(bool quick) {
    Variants variants;
    for (const char* pixels : {"0.5", "1", "3", "10", "30"}) {
        if (quick && std::string(pixels) == "0.5") continue;
        variants.push_back({"--for-pixels", pixels, {}, {}});
        variants.back().for_pixels = pixels;
        variants.back().exact = std::string(pixels) == (quick ? "1" : "0.5");
    }
    return variants;
}

Variants grain_methods() {
    Variants variants = {{"grains", "cells", {}, {"opal.grains=cells"}},
                         {"grains", "sphere tracing", {}, {"opal.grains=sphere-tracing"}},
                         {"grains", "hyperboloid as printed", {}, {"opal.grains=hyperboloid"}}};
    variants.front().exact = true;
    return variants;
}

Variants diffraction_models(bool quick) {
    Variants variants = {{"diffraction", "two-beam", {}, {}},
                         {"diffraction", "laue", {}, {"opal.diffraction=laue"}},
                         {"diffraction", "none", {}, {"opal.diffraction=none"}}};
    variants.front().exact = true;
    for (const char* tolerance : {"0.1", "0.03", "0.01", "0.001"})
        if (!quick || std::string(tolerance) == "0.01")
            variants.push_back({"diffraction",
                                fmt::format("ewald-fresnel {}", tolerance),
                                {},
                                {"opal.diffraction=ewald-fresnel", fmt::format("opal.ewald_tolerance={}", tolerance)}});
    return variants;
}

/// A number that has the exact value at its end.
Variants numbers(const std::string& choice, const std::string& key, const std::vector<int>& values,
                 const std::vector<std::string>& beside = {}) {
    Variants variants;
    for (const int value : values) {
        std::vector<std::string> settings = beside;
        settings.push_back(fmt::format("{}={}", key, value));
        variants.push_back({choice, fmt::format("{}", value), {}, settings});
    }
    variants.back().exact = true;
    return variants;
}

Variants wavelengths() {
    Variants variants;
    for (const int companions : {0, 1, 3, 7}) {
        variants.push_back(
            {"wavelengths", fmt::format("1 + {}", companions), {}, {fmt::format("opal.companions={}", companions)}});
        variants.back().exact = companions == 3;
    }
    variants.push_back({"wavelengths", "one of 48", {}, {"opal.companions=0"}, SpectralChoice::bins_10nm});
    variants.push_back({"wavelengths", "RGB", {}, {"opal.companions=2"}, SpectralChoice::rgb});
    return variants;
}

Variants words(const std::string& choice, const std::string& key, const std::vector<std::string>& values) {
    Variants variants;
    for (const std::string& value : values) variants.push_back({choice, value, {}, {fmt::format("{}={}", key, value)}});
    variants.front().exact = true;
    return variants;
}

/// Mean cosine of the scattering of a missing sphere at 550 nm: what simpler phase functions are given.
double vacancy_asymmetry(const ParetoScene& scene) {
    CrystalDefect defect;
    defect.n_sphere = scene.n_sphere;
    defect.n_medium = scene.n_medium;
    defect.diameter_nm = scene.sphere_diameter_nm;
    return mie_efficiencies(mie_coefficients(defect.size_parameter(550.0), defect.relative_index(550.0))).asymmetry;
}

Variants phase_functions(const ParetoScene& scene) {
    const std::string asymmetry = fmt::format("base_color.mie_asymmetry={:.6f}", vacancy_asymmetry(scene));
    Variants variants = {{"phase function", "lorenz-mie", {"base_color.mie_phase=lorenz-mie"}, {}},
                         {"phase function", "henyey-greenstein", {"base_color.mie_phase=henyey-greenstein", asymmetry}, {}},
                         {"phase function", "draine", {"base_color.mie_phase=draine", asymmetry}, {}},
                         {"phase function", "schlick", {"base_color.mie_phase=schlick", asymmetry}, {}}};
    variants.front().exact = true;
    return variants;
}

Variants trackings() {
    Variants variants;
    for (const char* tracking : {"residual", "ratio"})
        for (const char* majorants : {"local", "global"})
            variants.push_back({"tracking",
                                fmt::format("{}, {} majorants", tracking, majorants),
                                {},
                                {fmt::format("opal.tracking={}", tracking), fmt::format("opal.majorants={}", majorants)}});
    variants.front().exact = true;
    return variants;
}

/// Exact patches, or triangles from level sets; the grains are exact in all.
Variants tessellations(const ParetoScene& scene, bool quick) {
    Variants variants = {
        {"shape", "exact patches", {voxels_along(scene, quick ? 64 : 256), only_cells}, {"object.0.exact=true"}}};
    variants.front().exact = true;
    for (const int count : quick ? std::vector<int>{64} : std::vector<int>{32, 64, 128, 256})
        variants.push_back({"shape",
                            fmt::format("triangles, {} voxels", count),
                            {voxels_along(scene, count), only_cells},
                            {"object.0.exact=false"}});
    return variants;
}

/// Single precision, also with the hierarchy that double precision has; the same scene turned about the vertical, all of it: the
/// same picture in other roundings; and double.
Variants precisions() {
    const double turn_rad = units::rad_from_deg(37.0), distance_mm = 32.0;
    Variants variants = {
        {"precision", "single", {}, {}},
        {"precision", "single, own tree", {}, {}},
        {"precision",
         "single, scene turned by 37 degrees",
         {},
         {fmt::format("camera.position_mm=[{}, {}, 24.0]", distance_mm * std::sin(turn_rad), -distance_mm * std::cos(turn_rad)),
          "environment.rotate_deg=37.0", "object.0.rotate_deg=[0.0, 0.0, 37.0]"}},
        {"precision", "double, own tree", {}, {}}};
    variants[1].tracing = Tracing::own_tree;
    variants[3].tracing = Tracing::own_tree_in_double;
    variants[3].exact = true;
    return variants;
}

/// Whole sets of settings: the presets, and the source's own.
Variants whole_settings(const ParetoScene& scene, bool quick) {
    Variants variants = {{"all together", "default", {}, {}}};
    for (const QualityPreset& preset : quality_presets()) {
        variants.push_back({"all together", preset.name, {}, preset.scene_overrides()});
        variants.back().for_pixels = fmt::format("{}", preset.for_pixels);
    }
    variants.back().exact = true;
    variants.push_back({"all together",
                        "source: 512 voxels, ewald-fresnel, one of 48, global majorants, smits",
                        {voxels_along(scene, quick ? 128 : 512)},
                        {"opal.grains=voxels", "opal.diffraction=ewald-fresnel", "opal.companions=0",
                         "render.sampler=independent", "opal.majorants=global", "color.upsampling=smits"},
                        SpectralChoice::bins_10nm});
    return variants;
}

}  // namespace

std::vector<ParetoScene> pareto_scenes(const std::filesystem::path& examples, const std::filesystem::path& block, bool quick) {
    const auto example = [&](const std::string& name, double longest_mm, bool scatters, double diameter_nm, double n_medium) {
        return ParetoScene{name,
                           examples / name / "recipe.toml",
                           examples / name / "scene.toml",
                           longest_mm,
                           scatters,
                           false,
                           false,
                           diameter_nm,
                           1.45,
                           n_medium};
    };
    std::vector<ParetoScene> scenes = {example("precious_opal", 12.0, false, 300.0, 1.333)};
    if (!quick) {
        scenes.push_back(example("white_opal", 11.0, true, 290.0, 1.36));
        scenes.push_back(example("fire_opal", 11.0, true, 280.0, 1.41));
    }
    scenes.push_back({"block", block / "recipe.toml", block / "scene.toml", 8.0, true, true, false, 280.0, 1.4585, 1.333});
    scenes.push_back({"teapot", examples / "teapots" / "pink.toml", block.parent_path() / "teapot" / "scene.toml", 20.0, true,
                      false, true, 290.0, 1.45, 1.36});
    return scenes;
}

std::vector<std::vector<ParetoVariant>> pareto_choices(const ParetoScene& scene, bool quick) {
    if (scene.patches_alone) return {tessellations(scene, quick)};
    const auto few = [quick](std::vector<int> values) {
        return quick ? std::vector<int>{values.front(), values.back()} : values;
    };
    std::vector<Variants> choices = {
        resolutions(scene, quick),
        modelled_for_the_picture(quick),
        grain_methods(),
        diffraction_models(quick),
        numbers("largest odds", "opal.max_odds", few({25, 100, 400, 1600})),
        wavelengths(),
        words("sampler", "render.sampler", {"sobol", "stratified", "independent"}),
        words("upsampling", "color.upsampling", {"jakob-hanika", "smits", "basis"}),
        numbers("bounces", "render.max_bounces", few({4, 8, 16, 32, 64, 256, 1024})),
        words("roulette", "render.roulette", {"true", "false"}),
        precisions(),
        whole_settings(scene, quick),
    };
    if (scene.scatters) {
        choices.push_back(words("guided", "render.guided", {"false", "true"}));
        choices.push_back(phase_functions(scene));
    }
    if (scene.varies) {
        choices.push_back(trackings());
        choices.push_back(words("dispersion", "opal.dispersion", {"full", "bands", "none"}));
    }
    return choices;
}

}  // namespace opal
