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

TEST(Recipe, OverridesSetAnyKey) {
    const Recipe recipe = parse(minimal, {"grains.num_sites=7", "base_color.absorber=neutral", "shape.size_mm=[1, 2, 3]",
                                          "grains.weight[0].amplitude=0.25"});
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

TEST(Recipe, OverrideErrorsNameTheOverride) {
    EXPECT_INPUT_ERROR(parse(minimal, {"grains.num_sites=0"}), "--set grains.num_sites=0: grains.num_sites: 0 is out of range");
    EXPECT_INPUT_ERROR(parse(minimal, {"grains.sites=3"}), "--set grains.sites=3: unknown key 'grains.sites'");
    EXPECT_INPUT_ERROR(parse(minimal, {"grains"}), "expected key=value");
    EXPECT_INPUT_ERROR(parse(minimal, {"shape.kind.deep=3"}), "is not in a table");
}

TEST(Recipe, MissingFile) {
    EXPECT_INPUT_ERROR(read_recipe("no_such_recipe.toml", {}), "no_such_recipe.toml: no such file");
    EXPECT_INPUT_ERROR(read_recipe("/", {}), "is a folder");
}

}  // namespace
}  // namespace opal
