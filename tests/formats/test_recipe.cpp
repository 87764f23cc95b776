// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "expect_error.h"
#include "formats/recipe.h"

namespace opal {
namespace {

const std::string minimal = "[shape]\nkind = \"ellipsoid\"\n";

Recipe parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return parse_recipe(text, "r.toml", overrides);
}

TEST(Recipe, EverythingButTheShapeHasADefault) {
    const Recipe recipe = parse(minimal);
    EXPECT_EQ(recipe.grains.num_sites, 900);
    EXPECT_EQ(recipe.crystal.sphere_diameter_nm, 250.0);
    EXPECT_EQ(recipe.base_color.absorber, "carbon");
    EXPECT_EQ(recipe.resolution, 256);
}

TEST(Recipe, ResolvedTextReadsBackToTheSameText) {
    const Recipe recipe = parse(
        "[shape]\nkind = \"cabochon\"\nsize_mm = [12, 9, 4.5]\n[grains]\nvoxel_size_mm = 0.05\n"
        "sintering = { grains = 500 }\n[crystal]\nn_medium = 1.0\n");
    const std::string text = recipe_to_toml(recipe);
    EXPECT_EQ(recipe_to_toml(parse(text)), text);
    EXPECT_NE(text.find("grains = 500"), std::string::npos);
    EXPECT_NE(text.find("voxel_size_mm = 0.05"), std::string::npos);
}

TEST(Recipe, EveryKeyReadsBack) {
    const std::vector<std::string> recipes = {
        "[shape]\nkind = \"bezier\"\npatches = \"teapot\"\nlongest_mm = 15\nchord_error_mm = 0.01\n[grains]\nresolution = 64\n"
        "sites = { kind = \"jittered-lattice\", region = \"bounds\", jitter = 0.5 }\n"
        "weight = [{ kind = \"linear\", direction = [1, 0, 0] }, { kind = \"grid\", file = \"w.vdb\", grid = \"density\" }]\n"
        "limit_weights = false\nboundary_noise = { amplitude_mm = 0.1, scale_mm = 0.5, octaves = 3 }\n"
        "sintering = { graph = \"lattice\", mean_grain_mm = 1.2, preference = \"misorientation\", misorientation_deg = 12 }\n"
        "orientation = { kind = \"fibre\", axis = [0, 1, 0], lattice = [1, 1, 0], spread_deg = 5 }\n",
        minimal +
            "[grains]\nsites = { kind = \"file\", file = \"p.csv\", scale = 2 }\ntessellation = \"manhattan\"\n"
            "weight = { kind = \"radial\", center_mm = [1, 2, 3] }\norientation = { kind = \"table\", file = \"o.csv\" }\n"
            "[crystal]\nstacking_fault_probability = 0.2\nmosaic_spread_deg = 1\n[base_color]\n"
            "sigma_a_field = { kind = \"noise\", contrast = 0.9, scale_mm = 4, octaves = 2 }\n"
            "sigma_s_rayleigh_field = { kind = \"layers\", direction = [1, 1, 0] }\n"
            "sigma_s_mie_field = { kind = \"grid\", file = \"f.vdb\", grid = \"d\", voxel_size_mm = 0.2 }\n"
            "[output]\ngrids = [\"sites\", \"weight\"]\nfor_blender = true\n",
        minimal +
            "[crystal]\nn_sphere = \"silica\"\nn_medium = \"resin\"\n[base_color]\ndefect_concentration = 0.013\n"
            "mie_phase = \"lorenz-mie\"\nmie_particle = \"sphere\"\nmie_particle_diameter_nm = 90\n",
        minimal + "[base_color]\nsigma_s_mie_per_mm = 0.2\nmie_phase = \"draine\"\nmie_asymmetry = -0.4\ndraine_alpha = 7\n",
        minimal + "[base_color]\nsigma_s_mie_per_mm = 0.2\nmie_phase = \"schlick\"\n"};
    for (const std::string& recipe : recipes) {
        const std::string text = recipe_to_toml(parse(recipe));
        EXPECT_EQ(recipe_to_toml(parse(text)), text);
    }
    const Recipe second = parse(recipes[1]);
    EXPECT_EQ(second.base_color.sigma_s_mie_field.voxel_size_mm, 0.2);
    EXPECT_EQ(second.output.grids, (std::vector<OutputGrid>{OutputGrid::weight, OutputGrid::sites}));
    EXPECT_EQ(parse(recipes[0]).grains.weight[1].grid, "density");
    const Recipe defects = parse(recipe_to_toml(parse(recipes[2])));
    EXPECT_EQ(defects.crystal.n_sphere.name(), "silica");
    EXPECT_EQ(defects.crystal.n_medium.name(), "resin");
    EXPECT_EQ(defects.base_color.defect_concentration, 0.013);
    EXPECT_EQ(defects.base_color.mie_phase, MiePhase::lorenz_mie);
    EXPECT_EQ(defects.base_color.mie_particle, MieParticle::sphere);
    EXPECT_EQ(defects.base_color.mie_particle_diameter_nm, 90.0);
    const BaseColorRecipe draine = parse(recipe_to_toml(parse(recipes[3]))).base_color;
    EXPECT_EQ(draine.mie_phase, MiePhase::draine);
    EXPECT_EQ(draine.mie_asymmetry, -0.4);
    EXPECT_EQ(draine.draine_alpha, 7.0);
    EXPECT_EQ(parse(recipe_to_toml(parse(recipes[4]))).base_color.mie_phase, MiePhase::schlick);
}

TEST(Recipe, OverridesSetAnyKey) {
    const Recipe recipe = parse(minimal, {"grains.num_sites=7", "base_color.absorber=neutral", "shape.size_mm=[1, 2, 3]",
                                          "grains.weight.amplitude=0.25"});
    EXPECT_EQ(recipe.grains.num_sites, 7);
    EXPECT_EQ(recipe.base_color.absorber, "neutral");
    EXPECT_EQ(recipe.shape.size_mm[1], 2.0);
    EXPECT_EQ(recipe.grains.weight[0].amplitude, 0.25);
}

TEST(Recipe, AnOverrideTakesThePlaceOfItsAlternative) {
    const Recipe recipe = parse(minimal + "[grains]\nvoxel_size_mm = 0.05\nsintering = { probability = 0.1 }\n",
                                {"grains.resolution=64", "grains.sintering.grains=300"});
    EXPECT_EQ(recipe.resolution, 64);
    EXPECT_EQ(recipe.grains.sintering.target_grains, 300);
}

TEST(Recipe, AbsorberFilesAreRelativeToWhoNamesThem) {
    EXPECT_EQ(parse_recipe(minimal + "[base_color]\nabsorber = \"ink.csv\"\n", "sub/r.toml", {}).base_color.absorber,
              "sub/ink.csv");
    EXPECT_EQ(parse_recipe(minimal, "sub/r.toml", {"base_color.absorber=ink.csv"}).base_color.absorber, "ink.csv");
}

TEST(Recipe, ErrorsAreLocated) {
    EXPECT_INPUT_ERROR(parse(minimal + "[grains]\nnum_sites = 0\n"),
                       "r.toml:4:13: grains.num_sites: 0 is out of range; allowed: 1 to");
    EXPECT_INPUT_ERROR(parse(minimal + "[grains]\nnum_site = 5\n"),
                       "r.toml:4:1: unknown key 'grains.num_site'; did you mean 'num_sites'?");
    EXPECT_INPUT_ERROR(parse(minimal + "[grains]\nnum_sites = \"many\"\n"), "r.toml:4:13: grains.num_sites: expected an integer");
    EXPECT_INPUT_ERROR(parse(minimal + "[grains]\nsintering = { probability = 1.5 }\n"),
                       "sintering.probability: 1.5 is out of range; allowed: 0 to 1");
    EXPECT_INPUT_ERROR(parse(minimal + "[grains]\nsintering = { probability = -0.1 }\n"), "allowed: 0 to 1");
    EXPECT_INPUT_ERROR(parse(minimal + "[crystal]\nn_sphere = nan\n"), "r.toml:4:12: crystal.n_sphere: nan is out of range");
    EXPECT_INPUT_ERROR(parse(minimal + "[base_color]\nsigma_a_reference_nm = 900.0\n"),
                       "sigma_a_reference_nm: 900 is out of range; allowed: 360 to 830");
    EXPECT_INPUT_ERROR(parse(minimal + "[base_color]\nsigma_a_per_mm = -1.0\n"),
                       "sigma_a_per_mm: -1 is out of range; allowed: 0 to");
    EXPECT_INPUT_ERROR(parse("[shape]\nkind = \"elipsoid\"\n"), "r.toml:2:8: shape.kind: 'elipsoid' is not known");
    EXPECT_INPUT_ERROR(parse("[shape]\nkind = \"elipsoid\"\n"), "did you mean 'ellipsoid'?");
    EXPECT_INPUT_ERROR(parse("[grains]\nnum_sites = 5\n"), "shape: is needed");
    EXPECT_INPUT_ERROR(parse(minimal + "size_mm = [1, 2]\n"), "expected one number or [x, y, z], found 2 elements");
    EXPECT_INPUT_ERROR(parse(minimal + "size_mm = [1, 2, 0]\n"), "allowed: above 0");
    EXPECT_INPUT_ERROR(parse(minimal + "[grains\n"), "r.toml:3:");
    EXPECT_INPUT_ERROR(parse(minimal + "[grains]\nresolution = 64\nvoxel_size_mm = 0.1\n"), "either voxel_size_mm or resolution");
}

TEST(Recipe, KeysThatContradictEachOther) {
    EXPECT_INPUT_ERROR(parse(minimal + "[grains]\nnum_sites = 5\nsites = { kind = \"file\", file = \"p.csv\" }\n"),
                       "r.toml:4:13: grains.num_sites: the sites come from a file");
    EXPECT_INPUT_ERROR(parse(minimal + "[grains]\nsintering = { graph = \"lattice\" }\n"), "needs sites = { kind = \"jittered");
    EXPECT_INPUT_ERROR(parse(minimal + "[grains]\nsintering = { grains = 5, mean_grain_mm = 1 }\n"), "give one of probability");
    EXPECT_INPUT_ERROR(parse(minimal + "[grains]\nsintering = { preference = \"misorientation\" }\n"
                                       "orientation = { kind = \"table\", file = \"q.csv\" }\n"),
                       "a table orients finished grains");
    EXPECT_INPUT_ERROR(parse(minimal + "[grains]\ntessellation = \"manhattan\"\nsintering = { preference = \"area\" }\n"),
                       "additive and voronoi tessellations alone");
    EXPECT_INPUT_ERROR(parse(minimal + "[grains]\nweight = []\n"), "a sum needs at least one term");
    EXPECT_INPUT_ERROR(parse(minimal + "[grains]\nweight = { kind = \"csv\" }\n"), "a weight of kind csv needs a file");
    EXPECT_INPUT_ERROR(parse(minimal + "[grains]\nweight = { kind = \"linear\", direction = [0, 0, 0] }\n"), "points nowhere");
    EXPECT_INPUT_ERROR(parse(minimal + "[output]\ngrids = [\"shape\"]\n"), "needs grain_id or sites");
    EXPECT_INPUT_ERROR(parse(minimal + "[output]\ngrids = [\"grains\"]\n"), "'grains' is not known");
    EXPECT_INPUT_ERROR(parse(minimal + "[base_color]\nsigma_a_field = { contrast = 0.5 }\n"), "unknown key");
}

TEST(Recipe, ScatterersThatCannotBe) {
    EXPECT_INPUT_ERROR(parse(minimal + "[base_color]\ndefect_concentration = 0.01\nsigma_s_mie_per_mm = 0.3\n"),
                       "sigma_s_mie_per_mm follows from it: give one of the two");
    EXPECT_INPUT_ERROR(parse(minimal + "[base_color]\ndefect_concentration = 0.5\n"), "0.5 is out of range; allowed: 0 to 0.2");
    EXPECT_INPUT_ERROR(parse(minimal + "[base_color]\nmie_phase = \"mie\"\n"), "'mie' is not known");
    EXPECT_INPUT_ERROR(parse(minimal + "[base_color]\nmie_asymmetry = 1\n"), "1 is out of range; allowed: -0.99 to 0.99");
}

TEST(Recipe, OverrideErrorsNameTheOverride) {
    EXPECT_INPUT_ERROR(parse(minimal, {"grains.num_sites=0"}), "--set grains.num_sites=0: grains.num_sites: 0 is out of range");
    EXPECT_INPUT_ERROR(parse(minimal, {"grains.sits=3"}), "--set grains.sits=3: unknown key 'grains.sits'");
    EXPECT_INPUT_ERROR(parse(minimal, {"grains"}), "expected key=value");
    EXPECT_INPUT_ERROR(parse(minimal, {"shape.kind.deep=3"}), "is not in a table");
}

TEST(Recipe, MissingFile) {
    EXPECT_INPUT_ERROR(read_recipe("no_such_recipe.toml", {}), "no_such_recipe.toml: no such file");
    EXPECT_INPUT_ERROR(read_recipe("/", {}), "is a folder");
}

}  // namespace
}  // namespace opal
