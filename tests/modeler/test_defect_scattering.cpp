// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/defect_scattering.h"

#include <cmath>

#include "formats/crystal_defect.h"
#include "formats/units.h"
#include "modeler/build.h"
#include "modeler/info.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

Recipe tiny(const std::string& base_color, const std::string& crystal = "") {
    return parse_recipe("[shape]\nkind = \"box\"\nsize_mm = 2\n[grains]\nnum_sites = 5\nvoxel_size_mm = 0.2\n[crystal]\n" +
                            crystal + "[base_color]\n" + base_color,
                        "r.toml", {});
}

DefectScattering scattering_of(const Recipe& recipe) {
    return defect_scattering(recipe.crystal, recipe.base_color);
}

/// Defects of 4 nm scatter as Rayleigh says: C = (8/3) pi r^2 x^4 ((m^2 - 1) / (m^2 + 2))^2, 4 / (sqrt 2 d)^3 lattice sites per
/// volume. x is 0.03, so corrections stay below 0.1 %.
TEST(DefectScattering, SmallDefectsFollowRayleighsLaw) {
    const DefectScattering found =
        scattering_of(tiny("defect_concentration = 0.02\nmie_particle_diameter_nm = 4\nmie_particle = \"sphere\"\n"));
    const double n_eff = 0.740480 * 1.45 + 0.259520 * 1.333, index = 1.45 / n_eff;
    const double radius_mm = 2.0e-6, x = 2.0 * units::pi * 2.0 * n_eff / 550.0;
    const double polarizability = (index * index - 1.0) / (index * index + 2.0);
    const double cross_section_mm2 =
        8.0 / 3.0 * units::pi * radius_mm * radius_mm * std::pow(x, 4) * polarizability * polarizability;
    const double defects_per_mm3 = 0.02 * 4.0 / std::pow(std::sqrt(2.0) * 250.0e-6, 3);
    const double expected = defects_per_mm3 * cross_section_mm2;
    EXPECT_NEAR(found.sigma_s_550nm_per_mm, expected, 1.0e-3 * expected);
    ASSERT_EQ(found.shape.wavelength_nm.size(), 95u);
    EXPECT_EQ(found.shape.wavelength_nm.front(), 360.0);
    EXPECT_EQ(found.shape.wavelength_nm.back(), 830.0);
    for (std::size_t i = 0; i < found.shape.value.size(); ++i) {
        const double law = std::pow(550.0 / found.shape.wavelength_nm[i], 4);
        EXPECT_NEAR(found.shape.value[i], law, 2.0e-3 * law);
    }
    EXPECT_EQ(found.shape.at(550.0), 1.0);
}

TEST(DefectScattering, GrowsWithTheConcentrationAndVanishesWithTheContrast) {
    const double one = scattering_of(tiny("defect_concentration = 0.01\n")).sigma_s_550nm_per_mm;
    EXPECT_GT(one, 0.0);
    EXPECT_NEAR(scattering_of(tiny("defect_concentration = 0.03\n")).sigma_s_550nm_per_mm, 3.0 * one, 1.0e-12 * one);
    const DefectScattering none = scattering_of(tiny("defect_concentration = 0.01\n", "n_sphere = 1.4\nn_medium = 1.4\n"));
    EXPECT_EQ(none.sigma_s_550nm_per_mm, 0.0);
    EXPECT_TRUE(none.shape.value.empty());
}

/// Indices that vary give the particle's own contrast at each wavelength.
TEST(DefectScattering, DispersionCounts) {
    const Recipe recipe = tiny("defect_concentration = 0.01\n", "n_sphere = \"silica\"\nn_medium = \"water\"\n");
    const DefectScattering found = scattering_of(recipe);
    for (const double wavelength_nm : {360.0, 550.0, 700.0}) {
        CrystalDefect fixed;
        fixed.n_sphere = RefractiveIndex::of_material("silica").at(wavelength_nm);
        fixed.n_medium = RefractiveIndex::of_material("water").at(wavelength_nm);
        const double sites_per_mm3 = 4.0 / std::pow(std::sqrt(2.0) * 250.0e-6, 3);
        const double expected = 0.01 * sites_per_mm3 * fixed.cross_section_nm2(wavelength_nm) * 1.0e-12;
        EXPECT_NEAR(found.sigma_s_550nm_per_mm * found.shape.at(wavelength_nm), expected, 1.0e-9 * expected);
    }
}

TEST(DefectScattering, ComesIntoTheOpalAndItsDescription) {
    initialize_openvdb();
    const Recipe recipe = tiny(
        "defect_concentration = 0.01\nmie_phase = \"lorenz-mie\"\nsigma_s_mie_field = { kind = \"layers\", scale_mm = 1, "
        "contrast = "
        "0.5 }\n",
        "n_sphere = \"silica\"\nn_medium = \"water\"\n");
    const DefectScattering expected = scattering_of(recipe);
    const OpalAsset built = build_opal(recipe, [](const std::string&) {}).asset;
    const std::string path = testing_tools::temporary_file("defects.vdb");
    write_opal_asset(built, path);
    std::vector<std::string> notices;
    const OpalAsset asset = read_opal_asset(path, {}, notices);
    EXPECT_TRUE(notices.empty());
    EXPECT_EQ(asset.constants.mie_phase, MiePhase::lorenz_mie);
    EXPECT_EQ(asset.constants.sigma_s_mie_shape.value, expected.shape.value);
    // The field is a factor around 1 on what follows from the defects.
    ASSERT_TRUE(asset.sigma_s_mie);
    EXPECT_NEAR(asset.sigma_s_mie->tree().getValue({0, 0, 0}), expected.sigma_s_550nm_per_mm,
                0.501 * expected.sigma_s_550nm_per_mm);
    // The recipe inside the file says what was asked for, and reads back.
    EXPECT_NE(asset.recipe_toml.find("defect_concentration = 0.01"), std::string::npos);
    EXPECT_EQ(asset.recipe_toml.find("sigma_s_mie_per_mm"), std::string::npos);
    EXPECT_EQ(recipe_to_toml(parse_recipe(asset.recipe_toml, "r.toml", {})), asset.recipe_toml);

    const nlohmann::json mie = describe_opal(asset)["constants"]["mie"];
    EXPECT_EQ(mie["phase"], "lorenz-mie");
    EXPECT_EQ(mie["particle"], "vacancy");
    EXPECT_EQ(mie["particle_diameter_nm"], 250.0);
    EXPECT_TRUE(mie["follows_from_defects"].get<bool>());
    const std::string text = opal_info_text(describe_opal(asset));
    EXPECT_NE(text.find("(silica) in"), std::string::npos) << text;
    EXPECT_NE(text.find("scatterers  lorenz-mie, mean cosine"), std::string::npos) << text;
    EXPECT_NE(text.find("particle: vacancy, 250 nm across\ndefects     scatter"), std::string::npos) << text;
    std::filesystem::remove(path);
}

TEST(DefectScattering, AGivenCoefficientHasNoSpectrum) {
    initialize_openvdb();
    const OpalAsset asset =
        build_opal(tiny("sigma_s_mie_per_mm = 0.4\nmie_phase = \"draine\"\n"), [](const std::string&) {}).asset;
    EXPECT_EQ(asset.constants.sigma_s_mie_per_mm, 0.4);
    EXPECT_TRUE(asset.constants.sigma_s_mie_shape.value.empty());
    const std::string text = opal_info_text(describe_opal(asset));
    EXPECT_NE(text.find("scatterers  draine, mean cosine 0.8, alpha 1\n"), std::string::npos) << text;
    EXPECT_EQ(text.find("defects     scatter"), std::string::npos) << text;
}

}  // namespace
}  // namespace opal
