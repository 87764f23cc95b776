// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "../formats/expect_error.h"
#include "small_opal.h"

namespace opal {
namespace {

SceneDescription scene(const std::string& file, const std::string& object) {
    return parse_scene("[[object]]\nkind = \"opal\"\nfile = '" + file + "'\n" + object, "test.toml", {});
}

/// Once loaded, a file is not needed again, wherever the opal stands; with another seed or scale it is another opal.
TEST(OpalCache, LoadsAFileOnce) {
    SmallOpal small;
    small.voxel_mm = 0.3;
    const ScratchFolder folder;
    const std::string file = (folder / "opal.vdb").string();
    write_opal_asset(small.make(), file);
    std::vector<std::string> notices;
    const std::string turned = "translate_mm = [1, 2, 3]\nrotate_deg = [0, 10, 50]\n";
    const HostScene fresh(scene(file, turned), notices);
    OpalCache opals;
    const HostScene first(scene(file, ""), notices, &opals);
    std::filesystem::remove(file);
    const HostScene second(scene(file, turned), notices, &opals);
    ASSERT_EQ(second.meshes().size(), 1u);
    const MeshData &loaded = fresh.meshes()[0], &shared = second.meshes()[0];
    ASSERT_EQ(loaded.positions.size(), shared.positions.size());
    for (std::size_t i = 0; i < loaded.positions.size(); ++i) {
        ASSERT_EQ(loaded.positions[i].x, shared.positions[i].x);
        ASSERT_EQ(loaded.normals[i].z, shared.normals[i].z);
    }
    const RigidTransform &a = fresh.view().bodies[0].world_from_object, &b = second.view().bodies[0].world_from_object;
    EXPECT_EQ(a.origin.y, b.origin.y);
    EXPECT_EQ(a.rotation.w, b.rotation.w);
    EXPECT_EQ(first.view().bodies[0].orientations, second.view().bodies[0].orientations);
    EXPECT_INPUT_ERROR(HostScene(scene(file, "scale = 2\n"), notices, &opals), "no such file");
    EXPECT_INPUT_ERROR(HostScene(scene(file, "orientation_seed = 5\n"), notices, &opals), "no such file");
}

}  // namespace
}  // namespace opal
