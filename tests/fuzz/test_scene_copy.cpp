// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <malloc.h>

#include <filesystem>
#include <memory>

#include "case_random.h"
#include "renderer/core/path_tracer.h"
#include "renderer/cpu/light_guides.h"
#include "renderer/host/scene_copy.h"
#include "scene_text.h"
#include "seed_files.h"
#include "small_opal.h"

namespace opal::fuzz {
namespace {

std::vector<float> traced(const SceneView& scene, const EmbreeScene& intersector) {
    std::vector<float> found;
    const auto pixels = std::uint32_t(scene.width) * std::uint32_t(scene.height);
    for (std::uint32_t i = 0; i < 400; ++i) {
        PathWavelengths<4> wavelengths;
        PathCounters counters;
        SceneView four = scene;
        four.wavelengths = 4;
        const PathResult<4> result = trace_sample(four, intersector, i * 7919u % pixels, i, wavelengths, counters);
        found.insert(found.end(), result.radiance.v, result.radiance.v + 4);
    }
    return found;
}

/// A scene traced as it is, then from a copy when all that it was made of is gone. Returns the light found.
float expect_same_from_copy(const std::filesystem::path& file) {
    std::vector<std::string> notices;
    auto scene = std::make_unique<HostScene>(read_scene(file, {}), notices);
    const std::vector<MeshData> meshes = scene->meshes();
    const EmbreeScene intersector(meshes);
    auto guides = std::make_unique<LightGuides>(*scene, intersector);
    const std::vector<float> reference = traced(guides->scene(), intersector);
    HostArrayCopier copier;
    const SceneView copy = copied_scene(guides->scene(), copier);
    EXPECT_EQ(scene_memory(guides->scene()).total_bytes(), copier.total_bytes());
    // What is freed is overwritten, so that a pointer that was forgotten finds something else.
    mallopt(M_PERTURB, 0xA5);
    guides.reset();
    scene.reset();
    mallopt(M_PERTURB, 0);
    EXPECT_EQ(traced(copy, intersector), reference);
    float sum = 0.0f;
    for (const float value : reference) sum += value;
    return sum;
}

TEST(SceneCopy, RandomScenesGiveTheSameBits) {
    const ScratchFolder folder;
    make_seed_files((folder / "case.toml").parent_path());
    float sum = 0.0f;
    for (std::uint64_t i = 0; i < 40; ++i) {
        SCOPED_TRACE(i);
        CaseRandom random(3, i);
        write_bytes(folder / "case.toml", random_scene(random));
        sum += expect_same_from_copy(folder / "case.toml");
    }
    EXPECT_GT(sum, 0.0f);
}

TEST(SceneCopy, AMilkyOpalInFullViewGivesTheSameBits) {
    SmallOpal small;
    small.constants.mie_phase = MiePhase::lorenz_mie;
    small.constants.sigma_s_mie_per_mm = 1.0;
    small.fields[0] = [](const openvdb::Vec3d& place) { return 1.0 + 0.1 * place.x(); };
    const ScratchFolder folder;
    write_opal_asset(small.make(), folder / "opal.vdb");
    write_bytes(folder / "case.toml",
                "[render]\nwidth = 20\nheight = 20\nguided = true\n[camera]\nposition_mm = [0, -20, 0]\ntarget_mm = [0, 0, 0]\n"
                "vertical_fov_deg = 14\n[[light]]\nkind = \"sphere\"\nradius_mm = 2\nposition_mm = [0, 0, 20]\nradiance = 10\n"
                "[[object]]\nkind = \"opal\"\nfile = \"opal.vdb\"\n");
    EXPECT_GT(expect_same_from_copy(folder / "case.toml"), 0.0f);
}

}  // namespace
}  // namespace opal::fuzz
