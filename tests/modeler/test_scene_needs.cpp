// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/scene_needs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "modeler/box_shape.h"
#include "modeler/build.h"
#include "modeler/cabochon_shape.h"
#include "modeler/defect_scattering.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

const std::string recipe_text = "[shape]\nkind = \"box\"\nsize_mm = [8, 4, 2]\n[grains]\nvoxel_size_mm = 0.05\nnum_sites = 20\n";

/// The picture takes the grains from voxels.
const std::string voxels = "[opal]\ngrains = \"voxels\"\n";

/// A camera 50 mm away on -Y, looking at the origin: a picture of 600 lines spans 2 z tan(15 degrees) at depth z.
SceneDescription scene_with(const std::string& opal, const std::string& camera = "", const std::string& settings = "") {
    return parse_scene(
        "[render]\nwidth = 800\nheight = 600\n[camera]\nposition_mm = [0, -50, 0]\ntarget_mm = [0, 0, 0]\n"
        "vertical_fov_deg = 30\n" +
            camera + settings + "\n[[object]]\nkind = \"opal\"\nfile = \"gem.vdb\"\n" + opal,
        "s.toml", {});
}

Recipe recipe_with(const std::string& more = "") {
    return parse_recipe(recipe_text + more, "r.toml", {});
}

/// The recipe's box, about the origin.
class MiddleBox final : public Shape {
  public:
    double signed_distance_mm(const openvdb::Vec3d& point_mm) const override {
        return box_.signed_distance_mm(point_mm + openvdb::Vec3d(0.0, 0.0, 1.0));
    }
    openvdb::BBoxd bounds_mm() const override { return {{-4, -2, -1}, {4, 2, 1}}; }

  private:
    BoxShape box_{openvdb::Vec3d(8.0, 4.0, 2.0)};
};

SceneNeeds fit(Recipe& recipe, const SceneDescription& scene, double error_pixels = 1.0) {
    return fit_to_scene(recipe, scene, "out/gem.vdb", MiddleBox(), error_pixels);
}

double footprint_at(double depth_mm) {
    return 2.0 * depth_mm * std::tan(15.0 * std::acos(-1.0) / 180.0) / 600.0;
}

TEST(SceneNeeds, VoxelsFollowThePixelsAtTheNearestPoint) {
    Recipe recipe = recipe_with();
    const SceneNeeds needs = fit(recipe, scene_with(""));
    EXPECT_NEAR(needs.pixel_footprint_mm, footprint_at(48.0), 1.0e-12);  // the box reaches 2 mm towards the camera
    EXPECT_NEAR(needs.boundary_error_mm, needs.pixel_footprint_mm, 1.0e-12);
    EXPECT_NEAR(needs.boundary_error_pixels, 1.0, 1.0e-12);
    EXPECT_NEAR(recipe.grains.voxel_size_mm, 2.0 / std::sqrt(3.0) * footprint_at(48.0), 1.0e-12);
    Recipe finer = recipe_with();
    EXPECT_NEAR(fit(finer, scene_with(""), 0.25).voxel_size_mm, 0.25 * needs.voxel_size_mm, 1.0e-12);
}

TEST(SceneNeeds, TheGemsPlacementCounts) {
    Recipe a = recipe_with(), b = recipe_with(), c = recipe_with(), d = recipe_with();
    // Turned by 90 degrees about Z the long side points at the camera.
    EXPECT_NEAR(fit(a, scene_with("rotate_deg = [0, 0, 90]\n")).pixel_footprint_mm, footprint_at(46.0), 1.0e-12);
    // About X first: the 2 mm side points at the camera, and Z then leaves 8 mm across it.
    EXPECT_NEAR(fit(b, scene_with("rotate_deg = [90, 0, 0]\n")).pixel_footprint_mm, footprint_at(49.0), 1.0e-12);
    EXPECT_NEAR(fit(c, scene_with("translate_mm = [0, -10, 0]\n")).pixel_footprint_mm, footprint_at(38.0), 1.0e-12);
    // Twice as large: nearer, and a millimetre of the recipe spans two of the scene.
    EXPECT_NEAR(fit(d, scene_with("scale = 2\n")).pixel_footprint_mm, 0.5 * footprint_at(46.0), 1.0e-12);
}

TEST(SceneNeeds, OrthographicPicturesHaveOneScale) {
    Recipe recipe = recipe_with();
    const SceneNeeds needs = fit(recipe, scene_with("", "kind = \"orthographic\"\nview_height_mm = 12\n"));
    EXPECT_NEAR(needs.pixel_footprint_mm, 0.02, 1.0e-12);
}

TEST(SceneNeeds, ACameraInsideKeepsTheRecipe) {
    Recipe recipe = recipe_with();
    const SceneNeeds needs = fit(recipe, scene_with("translate_mm = [0, -49, 0]\n"));
    EXPECT_EQ(needs.pixel_footprint_mm, 0.0);
    EXPECT_EQ(recipe.grains.voxel_size_mm, 0.05);
    EXPECT_NE(scene_needs_summary(needs).find("recipe's resolution is kept"), std::string::npos);
}

TEST(SceneNeeds, OnlyWhatCannotBeSeenIsDropped) {
    // 2 x 0.5 x 1e-4 /mm over the diagonal of 9.2 mm: 0.0009 of the light; with 0.1 /mm nearly all of it.
    const std::string faint = "[base_color]\nsigma_a_per_mm = 1e-4\nsigma_a_field = { kind = \"noise\", contrast = 0.5 }\n";
    const std::string strong = "[base_color]\nsigma_a_per_mm = 0.1\nsigma_a_field = { kind = \"noise\", contrast = 0.5 }\n";
    const std::string grids = "[output]\ngrids = [\"grain_id\", \"shape\", \"weight\", \"sites\"]\nfor_blender = true\n";
    Recipe dropped = recipe_with(faint + grids), kept = recipe_with(strong);
    EXPECT_EQ(fit(dropped, scene_with("", "", voxels)).dropped.size(), 3u);
    EXPECT_EQ(dropped.base_color.sigma_a_field.kind, FieldKind::constant);
    EXPECT_FALSE(dropped.output.has(OutputGrid::weight));
    EXPECT_FALSE(dropped.output.for_blender);
    EXPECT_TRUE(fit(kept, scene_with("", "", voxels)).dropped.empty());
    EXPECT_EQ(kept.base_color.sigma_a_field.kind, FieldKind::noise);
}

TEST(SceneNeeds, LabelsAreLeftOutWhereTheSitesSayItAll) {
    const auto keeps_labels = [](const std::string& recipe_more, const std::string& settings) {
        Recipe recipe = recipe_with(recipe_more);
        const SceneNeeds needs = fit(recipe, scene_with("", "", settings));
        EXPECT_EQ(needs.exact_grains, !recipe.output.has(OutputGrid::grain_id));
        EXPECT_EQ(needs.exact_grains, scene_needs_summary(needs).find("grains are exact") != std::string::npos);
        return recipe.output.has(OutputGrid::grain_id);
    };
    EXPECT_FALSE(keeps_labels("", ""));
    EXPECT_FALSE(keeps_labels("tessellation = \"voronoi\"\n", "[opal]\ngrains = \"cells\"\n"));
    EXPECT_TRUE(keeps_labels("", voxels));
    EXPECT_TRUE(keeps_labels("tessellation = \"manhattan\"\n", ""));
    EXPECT_TRUE(keeps_labels("boundary_noise = { amplitude_mm = 0.1 }\n", ""));
    EXPECT_TRUE(keeps_labels("[output]\ngrids = [\"grain_id\", \"shape\"]\n", ""));
}

/// Seen by way of a mirror, perhaps: as fine as the pixels where it matters, and said with what error.
TEST(SceneNeeds, AGemBesideThePictureIsModelledAsIfInIt) {
    const auto fit_at = [](const std::string& target) {
        Recipe recipe = recipe_with();
        return fit_to_scene(recipe,
                            parse_scene("[render]\nwidth = 800\nheight = 600\n[camera]\nposition_mm = [0, -30, 2]\ntarget_mm = " +
                                            target + "\nvertical_fov_deg = 20\n[[object]]\nkind = \"opal\"\nfile = \"gem.vdb\"\n",
                                        "s.toml", {}),
                            "gem.vdb", CabochonShape({12.0, 9.0, 4.5}, 0.4), 1.0);
    };
    const SceneNeeds beside = fit_at("[30, 0, 2]"), in_it = fit_at("[0, 0, 2]");
    EXPECT_LE(beside.voxel_size_mm, 1.2 * in_it.voxel_size_mm);
    EXPECT_GT(beside.boundary_error_pixels, 0.5);
    EXPECT_GT(beside.surface_places, 1000u);
}

TEST(SceneNeeds, AllObjectsAndFramesCount) {
    const auto footprint = [](const std::string& objects, const std::string& animation = "") {
        Recipe recipe = recipe_with();
        return fit(recipe, scene_with(objects, "", animation)).pixel_footprint_mm;
    };
    const std::string near = "\n[[object]]\nkind = \"opal\"\nfile = \"gem.vdb\"\ntranslate_mm = [0, -10, 0]\n";
    EXPECT_NEAR(footprint("translate_mm = [30, 0, 0]\n" + near), footprint_at(38.0), 1.0e-12);
    // Half a turn about the target brings the gem 20 mm nearer; frames of a still object count as one.
    const std::string behind = "translate_mm = [0, 10, 0]\n";
    EXPECT_NEAR(footprint(behind), footprint_at(58.0), 1.0e-12);
    EXPECT_NEAR(footprint(behind, "[animation]\nframes = 2\ncamera_orbit_deg = 180\n"), footprint_at(38.0), 1.0e-9);
    EXPECT_NEAR(footprint(behind, "[animation]\nframes = 2\nlight_sweep_deg = 90\n"), footprint_at(58.0), 1.0e-12);
}

/// A plate of 20 x 20 x 0.3 mm keeps its thickness however few pixels show it; an edge close up takes no more than there is room
/// for.
TEST(SceneNeeds, PlatesRemainAndMacrosOfEdgesFit) {
    const auto fit_box = [](const openvdb::Vec3d& size_mm, const std::string& camera, const std::string& settings) {
        Recipe recipe = recipe_with();
        return fit_to_scene(recipe,
                            parse_scene("[render]\nwidth = 800\nheight = 600\n[camera]\n" + camera + settings +
                                            "\n[[object]]\nkind = \"opal\"\nfile = \"gem.vdb\"\n",
                                        "s.toml", {}),
                            "gem.vdb", BoxShape(size_mm), 3.0);
    };
    const std::string far = "position_mm = [0, -500, 300]\ntarget_mm = [0, 0, 0]\nvertical_fov_deg = 20\n";
    EXPECT_LE(fit_box({20.0, 20.0, 0.3}, far, "").voxel_size_mm, 0.3 / 16.0 + 1.0e-12);
    EXPECT_LE(fit_box({20.0, 20.0, 0.3}, far, voxels).voxel_size_mm, 0.3 / 4.0 + 1.0e-12);
    const std::string edge = "position_mm = [0, -6, 5]\ntarget_mm = [0, -4, 4]\nvertical_fov_deg = 0.3\n";
    const SceneNeeds macro = fit_box({8.0, 8.0, 4.0}, edge, "");
    EXPECT_NEAR(macro.voxel_size_mm, 8.0 / 2000.0, 1.0e-12);
    EXPECT_TRUE(macro.finest_surface);
    EXPECT_GT(macro.boundary_error_pixels, 10.0);
    EXPECT_NE(scene_needs_summary(macro).find("for its edges or thin parts"), std::string::npos) << scene_needs_summary(macro);
}

TEST(SceneNeeds, FieldsAreJudgedWhereTheAbsorberIsStrongest) {
    // 0.0001 /mm at 630 nm, but many times as much at 360 nm.
    Recipe recipe = recipe_with(
        "[base_color]\nabsorber = \"iron-oxide\"\nsigma_a_reference_nm = 630\nsigma_a_per_mm = 1e-4\n"
        "sigma_a_field = { kind = \"noise\", contrast = 0.5 }\n");
    fit(recipe, scene_with(""));
    EXPECT_EQ(recipe.base_color.sigma_a_field.kind, FieldKind::noise);
}

TEST(SceneNeeds, FieldsOfDefectsAreJudgedWhereTheyScatterMost) {
    const auto recipe_of = [](double concentration) {
        return recipe_with("[base_color]\ndefect_concentration = " + std::to_string(concentration) +
                           "\nmie_particle_diameter_nm = 60\nsigma_s_mie_field = { kind = \"noise\", contrast = 0.5 }\n");
    };
    // Small particles: some 5 times as strong at 360 nm as at 550 nm.
    const Recipe dense = recipe_of(0.1);
    const double per_mm = defect_scattering(dense.crystal, dense.base_color).sigma_s_550nm_per_mm;
    Recipe kept = recipe_of(0.1 * 1.0e-4 / per_mm), dropped = recipe_of(0.1 * 1.0e-5 / per_mm);
    EXPECT_TRUE(fit(kept, scene_with("", "", voxels)).dropped.empty());
    EXPECT_EQ(fit(dropped, scene_with("", "", voxels)).dropped.size(), 1u);
}

TEST(SceneNeeds, AFarGemKeeps32Voxels) {
    Recipe recipe = recipe_with();
    EXPECT_EQ(fit(recipe, scene_with("translate_mm = [0, 1e5, 0]\n", "", voxels)).voxel_size_mm, 0.25);
    EXPECT_EQ(fit(recipe, scene_with("translate_mm = [0, 1e5, 0]\n")).voxel_size_mm, 8.0 / 96.0);  // the surface alone
}

/// 12 x 9 x 4.5 mm with a rim of 0.4 mm, from 12 mm: dome alone in the picture, or all of it.
SceneNeeds fit_cabochon(const std::string& fov, const std::string& recipe_more, const std::string& settings) {
    Recipe recipe = recipe_with(recipe_more);
    const SceneDescription scene = parse_scene(
        "[render]\nwidth = 800\nheight = 600\n[camera]\nposition_mm = [0, 0, 16]\ntarget_mm = [0, 0, 4]\nup = [0, 1, 0]\n"
        "vertical_fov_deg = " +
            fov + "\n" + settings + "\n[[object]]\nkind = \"opal\"\nfile = \"gem.vdb\"\n",
        "s.toml", {});
    return fit_to_scene(recipe, scene, "gem.vdb", CabochonShape({12.0, 9.0, 4.5}, 0.4), 1.0);
}

TEST(SceneNeeds, ASurfaceTakesNoFinerVoxelsThanItsCurvatureInThePicture) {
    const SceneNeeds dome = fit_cabochon("8", "", ""), all = fit_cabochon("60", "", "");
    // The dome's radius of curvature is some mm, the rim's 0.2 mm.
    EXPECT_NEAR(dome.voxel_size_mm, 12.0 / 96.0, 1.0e-12);
    EXPECT_LT(all.voxel_size_mm, std::sqrt(2.0 * 0.2 * all.pixel_footprint_mm * 1.5));
    EXPECT_GT(all.voxel_size_mm, 1.5 * all.pixel_footprint_mm);
    for (const SceneNeeds& needs : {dome, all}) {
        EXPECT_GT(needs.surface_places, 100u);
        EXPECT_GT(needs.boundary_error_mm, 0.0);
        EXPECT_GT(needs.boundary_error_pixels, 0.5);
        EXPECT_LE(needs.boundary_error_pixels, 1.0);
        EXPECT_NE(scene_needs_summary(needs).find("follow its curvature"), std::string::npos);
    }
    // Grains from voxels: as fine as the pixels.
    EXPECT_LT(fit_cabochon("8", "", voxels).voxel_size_mm, dome.voxel_size_mm / 20.0);
    // What varies in the body takes voxels too.
    const std::string field = "[base_color]\nsigma_a_per_mm = 0.1\nsigma_a_field = { kind = \"noise\", contrast = 0.5 }\n";
    EXPECT_LT(fit_cabochon("8", field, "").voxel_size_mm, dome.voxel_size_mm / 20.0);
}

TEST(SceneNeeds, WhichOpalIsMeant) {
    SceneDescription two = scene_with("");
    two.objects.push_back(two.objects.front());
    two.objects.back().file = "other.vdb";
    two.objects.back().scale = 2.0;
    Recipe recipe = recipe_with();
    const MiddleBox box;
    EXPECT_NEAR(fit_to_scene(recipe, two, "gem.vdb", box, 1.0).pixel_footprint_mm, footprint_at(48.0), 1.0e-12);
    EXPECT_NEAR(fit_to_scene(recipe, two, "other.vdb", box, 1.0).pixel_footprint_mm, 0.5 * footprint_at(46.0), 1.0e-12);
    const auto error = [&] { fit_to_scene(recipe, two, "third.vdb", box, 1.0); };
    EXPECT_NE(testing_tools::input_error_of(error).find("several opals (gem.vdb, other.vdb)"), std::string::npos);
    two.objects.clear();
    EXPECT_NE(testing_tools::input_error_of(error).find("no [[object]] of kind opal"), std::string::npos);
}

TEST(SceneNeeds, TheBuildUsesAndReportsThem) {
    const Recipe recipe = recipe_with("[output]\nfor_blender = true\n");
    const BuiltOpal built = build_opal(
        recipe, [](const std::string&) {}, SceneFit{scene_with(""), "gem.vdb", 4.0});
    ASSERT_TRUE(built.report.scene_needs.has_value());
    EXPECT_EQ(built.asset.grain_id, nullptr);
    EXPECT_NEAR(built.asset.shape->voxelSize().x(), 8.0 / 96.0, 1.0e-12);
    EXPECT_FALSE(built.output.for_blender);
    EXPECT_NE(built.asset.recipe_toml.find("voxel_size_mm = 0.0833"), std::string::npos) << built.asset.recipe_toml;
}

}  // namespace
}  // namespace opal
