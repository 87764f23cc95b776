// SPDX-License-Identifier: Apache-2.0
#include "modeler/build.h"

#include <algorithm>

#include "modeler/info.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

using testing_tools::input_error_of;

const BuildListener silent = [](const std::string&) {};

BuiltOpal build(const std::string& toml) {
    return build_opal(parse_recipe(toml, "test.toml", {}), silent);
}

const std::string small_opal = R"(
[shape]
kind = "cabochon"
size_mm = [6.0, 5.0, 3.0]
[grains]
num_sites = 300
voxel_size_mm = 0.06
seed = 5
sintering = { grains = 120 }
)";

TEST(Build, MakesACompleteAsset) {
    const BuiltOpal built = build(small_opal);
    const OpalAsset& asset = built.asset;
    EXPECT_EQ(asset.sites.size(), 300u);
    EXPECT_EQ(asset.num_grains(), 120u);
    EXPECT_EQ(asset.seed, 5u);
    EXPECT_EQ(asset.schema_version, opal_schema_version);
    EXPECT_FALSE(asset.program_version.empty());
    EXPECT_NE(asset.recipe_toml.find("num_sites = 300"), std::string::npos);
    EXPECT_DOUBLE_EQ(asset.grain_id->voxelSize().x(), 0.06);
    EXPECT_EQ(asset.grain_id->transform(), asset.shape->transform());
    EXPECT_NEAR(asset.constants.sigma_a_per_mm.at(550.0), 0.25, 1e-12);

    auto distances = asset.shape->getConstAccessor();
    for (auto value = asset.grain_id->cbeginValueOn(); value; ++value) {
        ASSERT_GE(*value, 1);
        ASSERT_LE(*value, 120);
        ASSERT_LT(distances.getValue(value.getCoord()), 0.0f);
    }
    // A site owns the place where it lies, so the nearest voxel inside the shape is its grain's, but for borders within that
    // voxel.
    std::size_t inside = 0, at_home = 0;
    for (const Site& site : asset.sites) {
        const openvdb::Coord voxel = openvdb::Coord::round(asset.grain_id->worldToIndex(site.position_mm));
        inside += asset.grain_id->tree().isValueOn(voxel) ? 1 : 0;
        at_home += asset.grain_id->tree().getValue(voxel) == site.grain ? 1 : 0;
    }
    EXPECT_GE(inside, 270u);
    EXPECT_GE(at_home + 3, inside);
}

TEST(Build, ReportCountsWhatIsThere) {
    const BuiltOpal built = build(small_opal);
    const BuildReport& report = built.report;
    EXPECT_EQ(report.hidden_sites, 0u);
    EXPECT_GT(report.bonds, 1500u);
    EXPECT_LT(report.kept_bonds, report.bonds);
    EXPECT_NEAR(report.mean_degree, 2.0 * double(report.bonds) / 300.0, 1e-12);
    EXPECT_EQ(report.voxels, built.asset.grain_id->activeVoxelCount());
    EXPECT_NEAR(double(report.voxels) * 0.06 * 0.06 * 0.06, report.shape_volume_mm3, 0.03 * report.shape_volume_mm3);
    EXPECT_GT(report.relative_radius, 0.6);
    const nlohmann::json json = report_to_json(report, built.asset);
    for (const char* key : {"seconds", "peak_memory_bytes", "counts", "versions", "seed", "recipe", "percolation_threshold",
                            "shortest_site_distance_mm", "relative_radius", "warnings"})
        EXPECT_TRUE(json.contains(key)) << key;
    for (const char* key :
         {"sites", "hidden_sites", "bonds", "mean_degree", "grains", "largest_grain_fraction", "voxels", "leaves", "tiles"})
        EXPECT_TRUE(json["counts"].contains(key)) << key;
    for (const char* stage : {"shape", "sites", "weights", "neighbour_graph", "sintering", "level_set", "labelling", "total"})
        EXPECT_TRUE(json["seconds"].contains(stage)) << stage;
    for (const char* library : {"opal", "openvdb", "tbb", "cgal", "compiler"})
        EXPECT_TRUE(json["versions"].contains(library)) << library;
    EXPECT_NE(report_summary(report, built.asset).find("120 from 300 sites"), std::string::npos);
}

TEST(Build, SameBitsOnAnyNumberOfThreads) {
    const auto one = testing_tools::with_threads(1, [] { return build(small_opal).asset; });
    const auto two = testing_tools::with_threads(2, [] { return build(small_opal).asset; });
    EXPECT_TRUE(testing_tools::same_grids(*one.grain_id, *two.grain_id));
    EXPECT_TRUE(testing_tools::same_grids(*one.shape, *two.shape));
    ASSERT_EQ(one.sites.size(), two.sites.size());
    for (std::size_t n = 0; n < one.sites.size(); ++n) {
        ASSERT_EQ(one.sites[n].position_mm, two.sites[n].position_mm);
        ASSERT_EQ(one.sites[n].weight_mm, two.sites[n].weight_mm);
        ASSERT_EQ(one.sites[n].grain, two.sites[n].grain);
    }
    ASSERT_EQ(one.num_grains(), two.num_grains());
    for (std::size_t n = 0; n < one.num_grains(); ++n)
        for (int i = 0; i < 4; ++i) ASSERT_EQ(one.grain_orientations[n][i], two.grain_orientations[n][i]);
}

TEST(Build, GrainStatisticsComeWithTheReport) {
    const BuiltOpal built = build(small_opal);
    const GrainStatistics& statistics = built.report.grain_statistics;
    EXPECT_NEAR(statistics.volume_mm3.mean * 120.0, double(built.report.voxels) * 0.06 * 0.06 * 0.06, 1e-9);
    EXPECT_NEAR(statistics.sites_per_grain.mean, 300.0 / 120.0, 1e-12);
    EXPECT_GT(statistics.neighbouring_grains, 300u);
    const nlohmann::json json = report_to_json(built.report, built.asset)["grain_statistics"];
    for (const char* key : {"volume_mm3", "diameter_mm", "sites_per_grain", "misorientation_deg"})
        for (const char* value : {"mean", "std", "min", "median", "max"}) EXPECT_TRUE(json[key].contains(value)) << key;
    EXPECT_EQ(json["diameter_mm"]["histogram"]["counts"].size(), 20u);
    EXPECT_EQ(json["misorientation_deg"]["histogram"]["mackenzie"].size(), 32u);
    EXPECT_NE(report_summary(built.report, built.asset).find("degrees apart on average"), std::string::npos);
}

TEST(Build, MeanGrainSizeIsReached) {
    std::string recipe = small_opal;
    recipe.replace(recipe.find("grains = 120"), 12, "mean_grain_mm = 1.0");
    const BuiltOpal built = build(recipe);
    // The number of grains is whole and the volume known to 1 %: a third of that in the diameter.
    EXPECT_NEAR(mean_grain_diameter_mm(built.asset), 1.0, 0.01);
}

TEST(Build, SinteringByMisorientationGivesGrainsTheirLowestSitesOrientation) {
    const std::string recipe =
        "[shape]\nkind = \"sphere\"\nsize_mm = 4.0\n[grains]\nresolution = 32\nnum_sites = 400\nseed = 3\n"
        "sintering = { grains = 200, preference = \"";
    const OpalAsset asset = build(recipe + "misorientation\" }\n").asset;
    ASSERT_EQ(asset.num_grains(), 200u);
    std::vector<char> seen(200, 0);
    for (std::size_t n = 0; n < asset.sites.size(); ++n) {
        const auto grain = std::size_t(asset.sites[n].grain) - 1;
        if (seen[grain] != 0) continue;
        seen[grain] = 1;
        EXPECT_EQ(asset.grain_orientations[grain], uniform_rotation(3, RandomStream::site_orientations, n + 1));
    }
}

TEST(Build, TextureAndTableOrientTheGrains) {
    const std::string sphere =
        "[shape]\nkind = \"sphere\"\nsize_mm = 4.0\n[grains]\nresolution = 32\nnum_sites = 2\nsintering = { probability = 0.0 "
        "}\n";
    const BuiltOpal fibre =
        build(sphere + "orientation = { kind = \"fibre\", axis = [0, 0, 1], lattice = [0, 0, 1], spread_deg = 0.0 }\n");
    for (const auto& q : fibre.asset.grain_orientations) EXPECT_NEAR(q.x() * q.x() + q.y() * q.y(), 0.0, 1e-12);
    const std::string file = testing_tools::write_test_file("orientations.csv", "1,0,0,0,1\n2,1,0,0,0\n");
    const BuiltOpal table = build(sphere + "orientation = { kind = \"table\", file = \"" + file + "\" }\n");
    ASSERT_EQ(table.asset.num_grains(), 2u);
    EXPECT_EQ(table.asset.grain_orientations[1].x(), 1.0f);
    EXPECT_NEAR(table.report.grain_statistics.misorientation_deg.max, 0.0, 1e-9);  // half a turn about a cube's axis
}

TEST(Build, FaultsAndMosaicReachTheAsset) {
    const BuiltOpal built = build(
        "[shape]\nkind = \"sphere\"\nsize_mm = 4.0\n[grains]\nresolution = 16\nnum_sites = 5\n"
        "[crystal]\nstacking_fault_probability = 0.125\nmosaic_spread_deg = 1.5\n");
    EXPECT_EQ(built.asset.constants.stacking_fault_probability, 0.125);
    EXPECT_EQ(built.asset.constants.mosaic_spread_deg, 1.5);
}

TEST(Build, ResolutionCountsVoxelsAlongTheLongestSide) {
    const BuiltOpal built =
        build("[shape]\nkind = \"ellipsoid\"\nsize_mm = [4.0, 8.0, 2.0]\n[grains]\nnum_sites = 10\nresolution = 64\n");
    EXPECT_DOUBLE_EQ(built.asset.grain_id->voxelSize().x(), 0.125);
}

TEST(Build, DelaunayGraphAndSingleSiteBuildToo) {
    const std::string sphere = "[shape]\nkind = \"sphere\"\nsize_mm = 4.0\n[grains]\nresolution = 32\n";
    EXPECT_GT(build(sphere + "num_sites = 60\nsintering = { graph = \"delaunay\", probability = 0.05 }\n").asset.num_grains(),
              1u);
    EXPECT_EQ(build(sphere + "num_sites = 1\n").asset.num_grains(), 1u);
}

TEST(Build, HiddenSitesAreReportedAndBelongToNoGrain) {
    const BuiltOpal built = build(
        "[shape]\nkind = \"sphere\"\nsize_mm = 4.0\n[grains]\nresolution = 48\nnum_sites = 200\n"
        "weight = { kind = \"perlin\", amplitude = 20.0, scale_mm = 1.0 }\nlimit_weights = false\n");
    const auto hidden =
        std::count_if(built.asset.sites.begin(), built.asset.sites.end(), [](const Site& site) { return site.grain == 0; });
    EXPECT_GT(hidden, 20);
    EXPECT_EQ(std::size_t(hidden), built.report.hidden_sites);
}

TEST(Build, LimitedWeightsAreReported) {
    const std::string opal =
        "[shape]\nkind = \"sphere\"\nsize_mm = 4.0\n[grains]\nresolution = 32\nnum_sites = 200\n"
        "weight = { kind = \"perlin\", amplitude = 20.0, scale_mm = 1.0 }\n";
    const BuiltOpal built = build(opal);
    EXPECT_EQ(built.report.hidden_sites, 0u);
    EXPECT_LT(built.report.weight_scale, 0.5);
    EXPECT_EQ(report_to_json(built.report, built.asset)["weight_scale"].get<double>(), built.report.weight_scale);
    ASSERT_FALSE(built.report.warnings.empty());
    EXPECT_NE(built.report.warnings[0].find("weights were multiplied by"), std::string::npos);
}

TEST(Build, EveryTessellationBuildsAndStandsInTheAsset) {
    for (const char* name : {"voronoi", "multiplicative", "manhattan"}) {
        const BuiltOpal built = build(std::string("[shape]\nkind = \"sphere\"\nsize_mm = 4.0\n[grains]\nresolution = 32\n"
                                                  "num_sites = 60\nboundary_noise = { amplitude_mm = 0.1 }\n"
                                                  "tessellation = \"") +
                                      name + "\"\n[output]\ngrids = [\"grain_id\", \"shape\", \"sites\", \"weight\"]\n");
        EXPECT_NE(built.asset.tessellation, TessellationKind::additive);
        EXPECT_EQ(built.asset.boundary_noise.amplitude_mm, 0.1);
        EXPECT_EQ(built.asset.weight != nullptr, built.asset.tessellation != TessellationKind::voronoi);
        EXPECT_EQ(built.report.hidden_sites, 0u);
        std::vector<char> seen(built.asset.num_grains() + 1, 0);
        for (auto value = built.asset.grain_id->cbeginValueOn(); value; ++value) seen[std::size_t(*value)] = 1;
        EXPECT_EQ(std::size_t(std::count(seen.begin(), seen.end(), 1)), built.asset.num_grains());
    }
}

TEST(Build, WarnsPastThePercolationThreshold) {
    std::vector<std::string> messages;
    const Recipe recipe = parse_recipe(
        "[shape]\nkind = \"sphere\"\nsize_mm = 4.0\n[grains]\nresolution = 16\nnum_sites = 500\nsintering = { probability = 0.3 "
        "}\n",
        "test.toml", {});
    const BuiltOpal built = build_opal(recipe, [&](const std::string& message) { messages.push_back(message); });
    ASSERT_EQ(built.report.warnings.size(), 1u);
    EXPECT_NE(built.report.warnings[0].find("one grain holds 9"), std::string::npos) << built.report.warnings[0];
    EXPECT_NE(built.report.warnings[0].find("(p 0.3, threshold about 0."), std::string::npos) << built.report.warnings[0];
    EXPECT_NE(std::find(messages.begin(), messages.end(), "warning: " + built.report.warnings[0]), messages.end());
}

TEST(Build, RefusesWhatCannotBeBuilt) {
    const std::string sphere = "[shape]\nkind = \"sphere\"\nsize_mm = 4.0\n[grains]\n";
    const auto error_for = [&](const std::string& grains) { return input_error_of([&] { build(sphere + grains); }); };
    EXPECT_NE(error_for("voxel_size_mm = 0.0005\n").find("voxels; at most"), std::string::npos)
        << error_for("voxel_size_mm = 0.0005\n");
    EXPECT_NE(error_for("voxel_size_mm = 11.0\nnum_sites = 3\n").find("no voxel's centre lies inside"), std::string::npos);
    EXPECT_NE(input_error_of([] {
                  build("[shape]\nkind = \"sphere\"\nsize_mm = 0.001\n[grains]\nresolution = 512\n");
              }).find("smaller than a .vdb can hold"),
              std::string::npos);
    EXPECT_NE(error_for("num_sites = 10\nlimit_weights = false\nweight = { amplitude = 100.0, scale_mm = 1.0 }\nsintering = { "
                        "grains = 10 }\n")
                  .find("cannot be reached"),
              std::string::npos);
}

TEST(Info, TellsTheEffectiveIndexAndTheColor) {
    const BuiltOpal built = build("[shape]\nkind = \"sphere\"\nsize_mm = 4.0\n[grains]\nresolution = 32\nnum_sites = 20\n");
    const nlohmann::json description = describe_opal(built.asset);
    // physics.md, section 2: silica 1.45 in water 1.333 gives n_eff 1.41964; 2 n_eff sqrt(2/3) d is then 579.6 nm for d = 250 nm.
    EXPECT_NEAR(description["constants"]["n_eff"].get<double>(), 1.41964, 1e-5);
    EXPECT_NEAR(description["constants"]["wavelength_111_normal_nm"].get<double>(), 579.57, 0.01);
    EXPECT_NEAR(description["size_mm"][0].get<double>(), 4.0, 0.126);
    const std::string text = opal_info_text(description);
    EXPECT_NE(text.find("579.6 nm"), std::string::npos) << text;
    EXPECT_NE(text.find("cells       additive\n"), std::string::npos) << text;
    EXPECT_NE(text.find("sites       20 (0 hidden)"), std::string::npos) << text;
}

TEST(Info, TellsDisorderBoundariesAndFields) {
    // Four whole periods of a sine around 2 mm^-1, between 1 and 3, symmetric about the sphere's middle.
    BuiltOpal built = build(
        "[shape]\nkind = \"sphere\"\nsize_mm = 4.0\n[grains]\nresolution = 32\nnum_sites = 20\n"
        "[crystal]\nstacking_fault_probability = 0.2\nmosaic_spread_deg = 1.5\n[base_color]\nsigma_s_mie_per_mm = 2.0\n"
        "sigma_s_mie_field = { kind = \"layers\", contrast = 0.5, scale_mm = 1.0 }\n");
    built.asset.tessellation = TessellationKind::manhattan;
    built.asset.boundary_noise.amplitude_mm = 0.05;
    const nlohmann::json description = describe_opal(built.asset);
    EXPECT_EQ(description["constants"]["stacking_fault_probability"], 0.2);
    EXPECT_EQ(description["constants"]["mosaic_spread_deg"], 1.5);
    EXPECT_EQ(description["tessellation"]["kind"], "manhattan");
    const nlohmann::json& field = description["fields"]["sigma_s_mie"];
    EXPECT_NEAR(field["min"].get<double>(), 1.0, 0.03);
    EXPECT_NEAR(field["max"].get<double>(), 3.0, 0.03);
    EXPECT_NEAR(field["mean"].get<double>(), 2.0, 0.1);
    const std::string text = opal_info_text(description);
    EXPECT_NE(text.find("cells       manhattan; boundaries displaced by up to 0.05 mm"), std::string::npos) << text;
    EXPECT_NE(text.find("field       sigma_s_mie: 1"), std::string::npos) << text;
    EXPECT_NE(text.find("stacking faults 0.2 per layer, mosaic spread 1.5 degrees"), std::string::npos) << text;
}

/// With sites alone in the file besides the shape, which nothing else would miss.
TEST(Build, ShapesThinnerThanVoxelsAreRefused) {
    const std::string thin =
        "[shape]\nkind = \"ellipsoid\"\nsize_mm = [0.65, 0.5, 0.025]\n[grains]\nresolution = 12\nnum_sites = 3\n"
        "[output]\ngrids = [\"shape\", \"sites\"]\n";
    EXPECT_NE(input_error_of([&] { build(thin); }).find("no voxel's centre lies inside the shape"), std::string::npos);
}

}  // namespace
}  // namespace opal
