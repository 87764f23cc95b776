// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <vector>

#include "renderer/host/grain_grid.h"
#include "small_opal.h"

namespace opal {
namespace {

struct Interval {
    int grain;
    double begin;
};

/// Grains along a ray by tiny steps through the OpenVDB grid: slow, and independent of the walk. Unlabelled voxels continue the
/// grain.
std::vector<Interval> march(const openvdb::Int32Grid& grid, openvdb::Vec3d origin, openvdb::Vec3d direction, double end) {
    std::vector<Interval> intervals;
    const auto accessor = grid.getConstAccessor();
    for (double t = 0.0; t < end; t += 2.0e-4) {
        const int grain = accessor.getValue(openvdb::Coord::round(grid.worldToIndex(origin + t * direction)));
        if (grain != 0 && (intervals.empty() || intervals.back().grain != grain)) intervals.push_back({grain, t});
    }
    return intervals;
}

std::vector<Interval> walk(const GrainField& field, Vec3 origin, Vec3 direction, float end) {
    std::vector<Interval> intervals;
    GrainWalk walker(field, origin, direction);
    float distance = 0.0f;
    int grain = 0;
    while ((grain = walker.next_grain(grain, distance, end)) != 0) intervals.push_back({grain, double(distance)});
    return intervals;
}

/// Sub-steps shorter than the march's own resolution may differ; longer stretches must not.
void expect_same(const std::vector<Interval>& walked, const std::vector<Interval>& marched, double end) {
    const auto at = [&](const std::vector<Interval>& intervals, double t) {
        int grain = 0;
        for (const Interval& interval : intervals)
            if (interval.begin <= t) grain = interval.grain;
        return grain;
    };
    int differing = 0, samples = 0;
    for (double t = 0.00073; t < end; t += 0.0051, ++samples) differing += at(walked, t) != at(marched, t) ? 1 : 0;
    EXPECT_LE(differing, samples / 100 + 1);
}

TEST(GrainWalk, EqualsSmallSteps) {
    // Big grains in fine voxels: the tree holds 8^3 tiles as well as mixed leaves.
    SmallOpal small;
    small.grains = 6;
    small.voxel_mm = 0.05;
    const OpalAsset asset = small.make();
    ASSERT_GT(asset.grain_id->tree().activeTileCount(), 0u);
    const GrainGridData grains(*asset.grain_id);
    for (int i = 0; i < 60; ++i) {
        const RandomBlock a = random_block(3, RandomStream::render_paths, std::uint64_t(i), 0);
        const RandomBlock b = random_block(3, RandomStream::render_paths, std::uint64_t(i), 1);
        const auto signed_unit = [](std::uint32_t bits) { return 2.0f * uniform_float(bits) - 1.0f; };
        const Vec3 origin{2.0f * signed_unit(a.value[0]), 2.0f * signed_unit(a.value[1]), 2.0f * signed_unit(a.value[2])};
        Vec3 direction = normalize({signed_unit(b.value[0]), signed_unit(b.value[1]), signed_unit(b.value[2])});
        if (i % 5 == 0) direction = {i % 10 == 0 ? 1.0f : 0.0f, i % 10 == 0 ? 0.0f : -1.0f, 0.0f};
        expect_same(walk(grains.field(), origin, direction, 4.0f),
                    march(*asset.grain_id, {origin.x, origin.y, origin.z}, {direction.x, direction.y, direction.z}, 4.0), 4.0);
    }
}

TEST(GrainWalk, HonoursTranslatedGrids) {
    auto grid = openvdb::Int32Grid::create(0);
    auto transform = openvdb::math::Transform::createLinearTransform(0.5);
    transform->postTranslate({10.0, 0.0, 0.0});
    grid->setTransform(transform);
    for (int i = 0; i < 8; ++i) grid->tree().setValueOn({i, 0, 0}, i < 4 ? 1 : 2);
    const GrainGridData grains(*grid);
    const auto found = walk(grains.field(), {9.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 20.0f);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_NEAR(found[0].begin, 0.75, 1e-5);
    EXPECT_NEAR(found[1].begin, 2.75, 1e-5);
}

TEST(GrainWalk, EmptySpaceEnds) {
    auto grid = openvdb::Int32Grid::create(0);
    grid->tree().setValueOn({0, 0, 0}, 1);
    const GrainGridData grains(*grid);
    EXPECT_TRUE(walk(grains.field(), {5.0f, 5.0f, 5.0f}, normalize({1.0f, 0.3f, 0.2f}), 1.0e6f).empty());
}

}  // namespace
}  // namespace opal
