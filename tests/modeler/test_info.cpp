// SPDX-License-Identifier: Apache-2.0
#include "modeler/info.h"

#include <algorithm>

#include "formats/recipe.h"
#include "modeler/build.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

TEST(Info, SaysWhereTheOpalLiesAndWhatItsFileHolds) {
    const Recipe recipe = parse_recipe(
        "[shape]\nkind = \"box\"\nsize_mm = [4.0, 3.0, 2.0]\n[grains]\nnum_sites = 20\nvoxel_size_mm = 0.1\n", "test.toml", {});
    const OpalAsset asset = build_opal(recipe, [](const std::string&) {}).asset;
    const nlohmann::json description = describe_opal(asset);
    EXPECT_EQ(description["grids"], (std::vector<std::string>{"grain_id", "shape", "sites"}));
    const std::string text = opal_info_text(description);
    // Voxels count by their centres, so the labelled extent is that of the box to half a voxel.
    for (int axis = 0; axis < 3; ++axis) {
        const double low_mm = description["lowest_corner_mm"][axis], size_mm = description["size_mm"][axis];
        const double expected_mm[3][2] = {{-2.0, 2.0}, {-1.5, 1.5}, {0.0, 2.0}};
        EXPECT_NEAR(low_mm, expected_mm[axis][0], 0.0501);
        EXPECT_NEAR(low_mm + size_mm, expected_mm[axis][1], 0.0501);
    }
    EXPECT_NE(text.find("\nextent      x "), std::string::npos) << text;
    EXPECT_NE(text.find("\ngrids       grain_id, shape, sites\n"), std::string::npos) << text;
    // 2 n_eff sqrt(2/3) d, n_eff = 0.74048 * 1.45 + 0.25952 * 1.333 = 1.41964, d = 250 nm.
    EXPECT_NE(text.find("\ncolor       up to 579.6 nm"), std::string::npos) << text;
}

}  // namespace
}  // namespace opal
