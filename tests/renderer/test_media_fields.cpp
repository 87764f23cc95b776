// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <openvdb/tools/ChangeBackground.h>

#include <limits>

#include "formats/error.h"
#include "formats/units.h"
#include "renderer/host/medium_fields.h"
#include "small_opal.h"

namespace opal {
namespace {

constexpr std::array<const char*, num_medium_fields> names = {"sigma_a_scale", "sigma_s_rayleigh_400nm", "sigma_s_mie"};

double uniform(std::uint64_t index, std::uint32_t which) {
    const RandomBlock block = random_block(3, RandomStream::bench, index, which);
    return uniform_double(block.value[0], block.value[1]);
}

/// A place inside a ball of radius 3 mm.
Vec3 place_in_ball(std::uint64_t index) {
    for (std::uint32_t attempt = 0;; ++attempt) {
        const openvdb::Vec3d p(6.0 * uniform(index, 3 * attempt) - 3.0, 6.0 * uniform(index, 3 * attempt + 1) - 3.0,
                               6.0 * uniform(index, 3 * attempt + 2) - 3.0);
        if (p.length() < 2.999) return {float(p.x()), float(p.y()), float(p.z())};
    }
}

double wavy(const openvdb::Vec3d& p) {
    return 1.0 + 0.9 * std::sin(3.0 * p.x() + 1.0) * std::cos(2.0 * p.y() - p.z());
}

/// Three fields of different kinds and voxels.
OpalAsset varied_ball() {
    SmallOpal small;
    small.grains = 1;
    OpalAsset asset = small.make();
    const openvdb::BBoxd box(openvdb::Vec3d(-4.0), openvdb::Vec3d(4.0));
    asset.sigma_a_scale = box_field(box, 0.13, wavy);
    asset.sigma_s_rayleigh_400nm = box_field(box, 0.37, [](const auto& p) { return std::exp(-p.z()); });
    asset.sigma_s_mie = box_field(box, 0.2, [](const auto& p) { return p.x() > 0.3 ? 2.0 : 0.0; });
    return asset;
}

TEST(MajorantGrid, RatioTrackingSplitsNothingOff) {
    const OpalAsset asset = varied_ball();
    for (const MajorantKind kind : {MajorantKind::local, MajorantKind::global}) {
        const MediumFields residual(asset, kind, 1.0, "test.vdb"), ratio(asset, kind, 1.0, "test.vdb", TrackingKind::ratio);
        const std::vector<MajorantCell>&given = residual.majorants()->cells(), &without = ratio.majorants()->cells();
        ASSERT_EQ(given.size(), without.size());
        bool any = false;
        for (std::size_t i = 0; i < given.size(); ++i) {
            for (int f = 0; f < num_medium_fields; ++f) {
                EXPECT_EQ(without[i].min[f], 0.0f);
                EXPECT_EQ(without[i].max[f], given[i].max[f]);
                any = any || given[i].min[f] > 0.0f;
            }
        }
        EXPECT_TRUE(any);
    }
}

TEST(MajorantGrid, BoundsEveryPlaceAndVoxelAtEveryWavelength) {
    const OpalAsset asset = varied_ball();
    const SampledSpectrum absorber = absorber_spectrum("light-blue-dye", 0.3);
    for (const MajorantKind kind : {MajorantKind::local, MajorantKind::global}) {
        const MediumFields fields(asset, kind, 1.0, "test.vdb");
        ASSERT_NE(fields.majorants(), nullptr);
        if (kind == MajorantKind::global)
            EXPECT_EQ(fields.majorants()->cells().size(), 1u);
        else
            EXPECT_GT(fields.majorants()->cells().size(), 1u);
        MediumView view;
        fields.attach(view);
        for (std::uint64_t i = 0; i < 20000; ++i) {
            const Vec3 place = place_in_ball(i);
            MajorantWalk walk;
            walk.start(view.majorants, place, {0.0f, 0.0f, 1.0f});
            double value[num_medium_fields];
            for (int f = 0; f < num_medium_fields; ++f) {
                value[f] = double(field_value(view.fields[f], place));
                ASSERT_GE(value[f], double(walk.cell().min[f]) * (1.0 - 1e-6)) << names[std::size_t(f)];
                ASSERT_LE(value[f], double(walk.cell().max[f]) * (1.0 + 1e-6)) << names[std::size_t(f)];
            }
            if (i % 100 != 0) continue;
            for (double wavelength_nm = 360.0; wavelength_nm <= 830.0; wavelength_nm += 1.0) {
                const double unit[num_medium_fields] = {absorber.at(wavelength_nm), std::pow(400.0 / wavelength_nm, 4), 1.0};
                double extinction = 0.0, low = 0.0, high = 0.0;
                for (int f = 0; f < num_medium_fields; ++f) {
                    extinction += unit[f] * value[f];
                    low += unit[f] * double(walk.cell().min[f]);
                    high += unit[f] * double(walk.cell().max[f]);
                }
                ASSERT_TRUE(low <= extinction * (1.0 + 1e-6) && extinction <= high * (1.0 + 1e-6)) << wavelength_nm;
            }
        }
        EXPECT_NO_THROW(check_majorants({fit_field(*asset.sigma_a_scale, *asset.shape), nullptr, nullptr}, view.majorants, names,
                                        "test.vdb"));
    }
}

/// What the walk calls the cell of a place is where the place is, all along a ray.
TEST(MajorantGrid, TheWalkFollowsTheRay) {
    const MajorantGrid grid({box_field({openvdb::Vec3d(-4.0), openvdb::Vec3d(4.0)}, 0.25, wavy), nullptr, nullptr},
                            {openvdb::Vec3d(-3.0), openvdb::Vec3d(3.0, 3.0, 1.0)}, 13);
    const MajorantView view = grid.view();
    EXPECT_EQ(view.size[2], 9);  // 4 mm in cells of 6/13 mm
    for (std::uint64_t i = 0; i < 200; ++i) {
        const Vec3 origin = 0.3f * place_in_ball(2 * i), direction = normalize(place_in_ball(2 * i + 1));
        MajorantWalk walk;
        walk.start(view, origin, direction);
        float from = 0.0f;
        for (int step = 0; step < 40 && walk.exit() < 20.0f; ++step, walk.step()) {
            const float middle = 0.5f * (from + walk.exit());
            if (walk.exit() - from > 1.0e-4f) {
                MajorantWalk there;
                there.start(view, origin + middle * direction, direction);
                EXPECT_EQ(&there.cell(), &walk.cell());
            }
            EXPECT_GE(walk.exit(), from - 1.0e-5f);
            from = walk.exit();
        }
    }
}

TEST(MajorantGrid, TilesAreBoundedAsTiles) {
    const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0f);
    // 10^12 voxels: a visit of each would not end.
    grid->tree().sparseFill({openvdb::Coord(-8192), openvdb::Coord(8191)}, 0.5f, true);
    grid->tree().setValueOn({100, 100, 100}, 0.75f);
    const MajorantGrid majorants({nullptr, nullptr, grid}, {openvdb::Vec3d(-4096.0), openvdb::Vec3d(4096.0)}, 16);
    int larger = 0;
    for (const MajorantCell& cell : majorants.cells()) {
        EXPECT_EQ(cell.min[2], 0.5f);
        EXPECT_EQ(cell.max[0], 1.0f);
        larger += cell.max[2] == 0.75f ? 1 : 0;
    }
    EXPECT_EQ(larger, 1);
}

std::string message_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(MajorantGrid, ValuesThatCannotBeAreErrorsWithGridAndVoxel) {
    const openvdb::BBoxd box(openvdb::Vec3d(-2.0), openvdb::Vec3d(2.0));
    const openvdb::FloatGrid::Ptr good = box_field(box, 0.25, wavy);
    const MajorantGrid majorants({nullptr, good, nullptr}, box, 4);
    const auto check = [&](const openvdb::FloatGrid::Ptr& field, const MajorantView& view) {
        return message_of([&] { check_majorants({nullptr, field, nullptr}, view, names, "bad.vdb"); });
    };
    EXPECT_EQ(check(good, majorants.view()), "");
    const auto with = [&](float value) {
        const openvdb::FloatGrid::Ptr field = good->deepCopy();
        field->tree().setValueOn({3, -2, 1}, value);
        return field;
    };
    EXPECT_EQ(check(with(std::numeric_limits<float>::quiet_NaN()), majorants.view()),
              "bad.vdb: grid sigma_s_rayleigh_400nm: voxel [3, -2, 1] holds nan; allowed: numbers from 0");
    EXPECT_EQ(check(with(-0.5f), majorants.view()),
              "bad.vdb: grid sigma_s_rayleigh_400nm: voxel [3, -2, 1] holds -0.5; allowed: numbers from 0");
    EXPECT_EQ(check(with(5.0f), majorants.view())
                  .find("bad.vdb: grid sigma_s_rayleigh_400nm: voxel [3, -2, 1] holds 5, outside the bounds of a majorant cell"),
              0u);
    std::vector<MajorantCell> lowered = majorants.cells();
    for (MajorantCell& cell : lowered) cell.max[1] *= 0.98f;
    EXPECT_NE(check(good, MajorantGrid(lowered, majorants.view()).view()), "");
}

/// Voxels inside the shape alone, as other programs write them: no fading towards the background.
TEST(FieldGrid, InterpolationAtTheSurfaceDoesNotFade) {
    const SmallOpal small;
    OpalAsset asset = small.make();
    const auto clip = [&](const openvdb::FloatGrid::Ptr& field) {
        for (auto value = field->beginValueOn(); value; ++value)
            if (field->indexToWorld(value.getCoord()).length() >= 3.0) value.setValueOff();
        openvdb::tools::changeBackground(field->tree(), 0.0f);
        for (auto value = field->beginValueOff(); value; ++value) value.setValue(0.0f);
        return field;
    };
    const openvdb::BBoxd box(openvdb::Vec3d(-4.0), openvdb::Vec3d(4.0));
    asset.sigma_s_mie = clip(box_field(box, 0.3, [](const auto&) { return 0.7; }));
    asset.sigma_a_scale = clip(box_field(box, 0.3, [](const auto& p) { return 4.0 + p.x(); }));
    const MediumFields fields(asset, MajorantKind::local, 1.0, "test.vdb");
    EXPECT_FALSE(fields.varies(MediumField::sigma_s_mie));
    EXPECT_FLOAT_EQ(float(fields.constant(MediumField::sigma_s_mie)), 0.7f);
    MediumView view;
    fields.attach(view);
    for (std::uint64_t i = 0; i < 20000; ++i) {
        // The mean of neighbours is off the plane by up to a voxel; deep inside nothing is.
        const Vec3 place = place_in_ball(i);
        EXPECT_NEAR(field_value(view.fields[0], place), 4.0f + place.x, length(place) < 2.4f ? 1e-4f : 0.3f);
    }
}

TEST(FieldGrid, WhereTheGridEndsInsideItsBackgroundCounts) {
    OpalAsset asset = SmallOpal().make();
    asset.sigma_s_mie = box_field({openvdb::Vec3d(-4.0), openvdb::Vec3d(0.01, 4.0, 4.0)}, 0.25, [](const auto&) { return 2.0; });
    openvdb::tools::changeBackground(asset.sigma_s_mie->tree(), 0.5f);
    const MediumFields fields(asset, MajorantKind::local, 1.0, "test.vdb");
    MediumView view;
    fields.attach(view);
    ASSERT_TRUE(fields.varies(MediumField::sigma_s_mie));
    for (std::uint64_t i = 0; i < 5000; ++i) {
        const Vec3 place = place_in_ball(i);
        const float across = min_of(max_of(place.x / 0.25f, 0.0f), 1.0f);
        EXPECT_NEAR(field_value(view.fields[2], place), 2.0f - 1.5f * across, length(place) < 2.5f ? 1e-4f : 1.5f);
    }
    float low = 2.0f, high = 0.5f;
    for (const MajorantCell& cell : fields.majorants()->cells()) {
        low = std::min(low, cell.min[2]);
        high = std::max(high, cell.max[2]);
    }
    EXPECT_EQ(low, 0.5f);
    EXPECT_EQ(high, 2.0f);
}

TEST(MediumFields, WhatDoesNotVaryIsDropped) {
    OpalAsset asset = SmallOpal().make();
    asset.constants.sigma_s_mie_per_mm = 0.3;
    const openvdb::BBoxd box(openvdb::Vec3d(-4.0), openvdb::Vec3d(4.0));
    asset.sigma_s_rayleigh_400nm = openvdb::FloatGrid::create(0.0f);  // no voxels at all
    asset.sigma_a_scale = box_field(box, 0.25, [](const auto&) { return 0.0; });
    asset.sigma_s_mie = box_field(box, 0.25, [](const auto&) { return 0.125; });
    const MediumFields fields(asset, MajorantKind::local, 1.0, "test.vdb");
    EXPECT_EQ(fields.majorants(), nullptr);
    EXPECT_EQ(fields.constant(MediumField::sigma_a_scale), 0.0);
    EXPECT_EQ(fields.constant(MediumField::sigma_s_rayleigh_400nm), 0.0);
    EXPECT_EQ(fields.constant(MediumField::sigma_s_mie), 0.125);
    MediumView view;
    fields.attach(view);
    EXPECT_EQ(view.majorants.cells, nullptr);
    for (const FieldView& field : view.fields) EXPECT_EQ(field.grid, nullptr);
}

}  // namespace
}  // namespace opal
