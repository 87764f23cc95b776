// SPDX-License-Identifier: Apache-2.0
#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointDataGrid.h>

#include <algorithm>

#include "expect_error.h"
#include "formats/field_summary.h"
#include "formats/opal_asset_io.h"
#include "formats/random.h"
#include "opal_asset_fixture.h"

namespace opal {
namespace {

using AssetGrids = OpalAssetTest;

/// A fog of `value` wherever the ball and its surroundings are.
openvdb::FloatGrid::Ptr ball_fog(float value, double voxel_size_mm) {
    const auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel_size_mm));
    const int reach = int(2.0 / voxel_size_mm) + 2;
    grid->tree().fill(openvdb::CoordBBox(openvdb::Coord(-reach), openvdb::Coord(reach)), value, true);
    grid->tree().setValueOn({0, 0, 0}, 2.0f * value);
    return grid;
}

OpalAsset with_every_grid(OpalAsset asset) {
    asset.weight = ball_fog(-0.25f, 0.5);
    asset.sigma_a_scale = ball_fog(1.5f, 0.4);
    asset.sigma_s_rayleigh_400nm = ball_fog(0.3f, 0.2);
    asset.sigma_s_mie = ball_fog(0.1f, 0.1);
    return asset;
}

std::vector<std::string> names_of(const RawOpalFile& raw) {
    std::vector<std::string> names;
    for (const auto& grid : raw.grids) names.push_back(grid->getName());
    return names;
}

bool contains(const std::vector<std::string>& lines, const std::string& part) {
    return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) { return line.find(part) != std::string::npos; });
}

TEST_F(AssetGrids, EveryGridComesBackInTheOrderOfTheSchema) {
    const OpalAsset asset = with_every_grid(two_grain_ball());
    write_opal_asset(asset, folder_ / "all.vdb", {WriteOpalOptions().grids, true});
    const std::vector<std::string> order = {
        "grain_id",    "shape",           "weight",         "sigma_a_scale", "sigma_s_rayleigh_400nm",
        "sigma_s_mie", "orientation_rgb", "grain_id_float", "sites"};
    const RawOpalFile raw = read_raw_opal_file(folder_ / "all.vdb");
    EXPECT_EQ(names_of(raw), order);
    const auto twin = openvdb::gridPtrCast<openvdb::FloatGrid>(raw.find("grain_id_float"));
    const auto colors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(raw.find("orientation_rgb"));
    ASSERT_TRUE(twin && colors);
    EXPECT_EQ(twin->activeVoxelCount(), asset.grain_id->activeVoxelCount());
    EXPECT_EQ(twin->transform(), asset.grain_id->transform());
    for (auto id = asset.grain_id->cbeginValueOn(); id; ++id) {
        ASSERT_EQ(twin->tree().getValue(id.getCoord()), float(*id));
        ASSERT_EQ(colors->tree().getValue(id.getCoord()), grain_display_color(*id));
    }

    const OpalAsset back = read(folder_ / "all.vdb");
    for (const auto& [written, read_back] : {std::pair(asset.weight, back.weight),
                                             {asset.sigma_a_scale, back.sigma_a_scale},
                                             {asset.sigma_s_rayleigh_400nm, back.sigma_s_rayleigh_400nm},
                                             {asset.sigma_s_mie, back.sigma_s_mie}}) {
        ASSERT_TRUE(read_back);
        EXPECT_EQ(written->transform(), read_back->transform());
        EXPECT_EQ(written->activeVoxelCount(), read_back->activeVoxelCount());
        EXPECT_EQ(read_back->tree().getValue({0, 0, 0}), written->tree().getValue({0, 0, 0}));
        EXPECT_EQ(read_back->tree().getValue({1, 0, 0}), written->tree().getValue({1, 0, 0}));
    }
    const AssetCheck check = check_opal_asset(folder_ / "all.vdb");
    EXPECT_TRUE(check.errors.empty()) << check.errors.front();
    EXPECT_TRUE(check.advice.empty()) << check.advice.front();
}

TEST_F(AssetGrids, OnlyTheChosenGridsAreWritten) {
    const OpalAsset asset = with_every_grid(two_grain_ball());
    write_opal_asset(asset, folder_ / "some.vdb", {{OutputGrid::grain_id, OutputGrid::fields}, false});
    EXPECT_EQ(names_of(read_raw_opal_file(folder_ / "some.vdb")),
              (std::vector<std::string>{"grain_id", "sigma_a_scale", "sigma_s_rayleigh_400nm", "sigma_s_mie"}));
    EXPECT_INPUT_ERROR(write_opal_asset(asset, folder_ / "none.vdb", {{OutputGrid::shape}, false}), "needs grain_id or sites");
    EXPECT_INPUT_ERROR(write_opal_asset(asset, folder_ / "twins.vdb", {{OutputGrid::sites}, true}),
                       "twins are made from grain_id");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "none.vdb"));
}

TEST_F(AssetGrids, SitesAloneAreAValidFile) {
    const OpalAsset asset = two_grain_ball();
    write_opal_asset(asset, folder_ / "sites.vdb", {{OutputGrid::sites}, false});
    EXPECT_EQ(names_of(read_raw_opal_file(folder_ / "sites.vdb")), std::vector<std::string>{"sites"});
    const OpalAsset back = read(folder_ / "sites.vdb");
    EXPECT_TRUE(notices_.empty());
    EXPECT_FALSE(back.grain_id);
    EXPECT_FALSE(back.shape);
    EXPECT_EQ(back.num_grains(), 2u);
    ASSERT_EQ(back.sites.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(back.sites[i].position_mm, asset.sites[i].position_mm);
    const AssetCheck check = check_opal_asset(folder_ / "sites.vdb");
    EXPECT_TRUE(check.errors.empty()) << check.errors.front();
    EXPECT_TRUE(contains(check.advice, "sites alone"));
}

TEST_F(AssetGrids, ConstantsOfTheWholeModelerComeBack) {
    OpalAsset asset = two_grain_ball();
    asset.constants.stacking_fault_probability = 0.125;
    asset.constants.mosaic_spread_deg = 1.5;
    asset.tessellation = TessellationKind::multiplicative;
    asset.boundary_noise = {0.03, 0.2, 3};
    write_opal_asset(asset, folder_ / "a.vdb");
    const OpalAsset back = read(folder_ / "a.vdb");
    EXPECT_EQ(back.constants.stacking_fault_probability, 0.125);
    EXPECT_EQ(back.constants.mosaic_spread_deg, 1.5);
    EXPECT_EQ(back.tessellation, TessellationKind::multiplicative);
    EXPECT_EQ(back.boundary_noise.amplitude_mm, 0.03);
    EXPECT_EQ(back.boundary_noise.scale_mm, 0.2);
    EXPECT_EQ(back.boundary_noise.octaves, 3);
}

/// What version 3 brought: indices over the wavelength and scatterers.
TEST_F(AssetGrids, ScatterersAndIndicesComeBack) {
    OpalAsset asset = two_grain_ball();
    OpalConstants& constants = asset.constants;
    constants.n_sphere = RefractiveIndex::of_material("silica");
    constants.n_medium = RefractiveIndex::from_text("360:1.34 550:1.335 830:1.33");
    constants.sigma_s_mie_per_mm = 0.3;
    constants.sigma_s_mie_shape = {{360.0, 550.0, 830.0}, {1.0 / 3.0, 1.0, 0.1}};
    constants.mie_phase = MiePhase::draine;
    constants.draine_alpha = 12.5;
    constants.mie_particle = MieParticle::sphere;
    constants.mie_particle_diameter_nm = 180.0;
    write_opal_asset(asset, folder_ / "a.vdb");
    const OpalConstants back = read(folder_ / "a.vdb").constants;
    EXPECT_EQ(back.n_sphere, constants.n_sphere);
    EXPECT_EQ(back.n_medium, constants.n_medium);
    EXPECT_EQ(back.sigma_s_mie_per_mm, 0.3);
    EXPECT_EQ(back.sigma_s_mie_shape.wavelength_nm, constants.sigma_s_mie_shape.wavelength_nm);
    EXPECT_EQ(back.sigma_s_mie_shape.value, constants.sigma_s_mie_shape.value);
    EXPECT_EQ(back.mie_phase, MiePhase::draine);
    EXPECT_EQ(back.draine_alpha, 12.5);
    EXPECT_EQ(back.mie_particle, MieParticle::sphere);
    EXPECT_EQ(back.mie_particle_diameter_nm, 180.0);
}

TEST_F(AssetGrids, FilesOfSchemaTwoStillRead) {
    write_opal_asset(two_grain_ball(), folder_ / "a.vdb");
    RawOpalFile raw = read_raw_opal_file(folder_ / "a.vdb");
    for (const char* key : {"mie_phase", "draine_alpha", "mie_particle", "mie_particle_diameter_nm"})
        raw.metadata.removeMeta(key);
    EXPECT_INPUT_ERROR(asset_from_raw(raw, "cut.vdb", {}, notices_), "cut.vdb: metadata 'mie_phase' is missing");
    raw.metadata.removeMeta("opal_schema_version");
    raw.metadata.insertMeta("opal_schema_version", openvdb::Int32Metadata(2));
    const OpalAsset old = asset_from_raw(raw, "old.vdb", {}, notices_);
    EXPECT_TRUE(notices_.empty());
    EXPECT_EQ(old.schema_version, 2);
    EXPECT_EQ(old.constants.mie_phase, MiePhase::henyey_greenstein);
    EXPECT_FALSE(old.constants.n_sphere.varies());
    EXPECT_TRUE(old.constants.sigma_s_mie_shape.value.empty());
}

TEST_F(AssetGrids, FilesOfSchemaOneStillRead) {
    write_opal_asset(two_grain_ball(), folder_ / "a.vdb");
    RawOpalFile raw = read_raw_opal_file(folder_ / "a.vdb");
    const auto drop_new_keys = [&] {
        for (const char* key : {"stacking_fault_probability", "mosaic_spread_deg", "tessellation", "boundary_noise_amplitude_mm",
                                "boundary_noise_scale_mm", "boundary_noise_octaves", "orientations", "mie_phase", "draine_alpha",
                                "mie_particle", "mie_particle_diameter_nm"})
            raw.metadata.removeMeta(key);
    };
    drop_new_keys();
    EXPECT_INPUT_ERROR(asset_from_raw(raw, "cut.vdb", {}, notices_), "cut.vdb: metadata 'stacking_fault_probability' is missing");
    raw.metadata.removeMeta("opal_schema_version");
    raw.metadata.insertMeta("opal_schema_version", openvdb::Int32Metadata(1));
    const OpalAsset old = asset_from_raw(raw, "old.vdb", {}, notices_);
    EXPECT_TRUE(notices_.empty());
    EXPECT_EQ(old.schema_version, 1);
    EXPECT_EQ(old.sites.size(), 3u);
    EXPECT_EQ(old.constants.mosaic_spread_deg, 0.0);
    EXPECT_EQ(old.tessellation, TessellationKind::additive);
    raw.metadata.removeMeta("opal_schema_version");
    raw.metadata.insertMeta("opal_schema_version", openvdb::Int32Metadata(opal_schema_version + 1));
    EXPECT_INPUT_ERROR(asset_from_raw(raw, "new.vdb", {}, notices_), "opal schema 4 is not known; this program reads 1 to 3");
}

TEST_F(AssetGrids, SitesComeBackExactly) {
    OpalAsset asset = two_grain_ball();
    asset.sites.clear();
    for (std::uint64_t n = 0; n < 2000; ++n) {
        Site site;
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            const RandomBlock block = random_block(7, RandomStream::pixel_scramble, n, axis);
            site.position_mm[int(axis)] = 12.0 * uniform_double(block.value[0], block.value[1]) - 3.0;
        }
        site.grain = 1 + std::int32_t(n % 2);
        asset.sites.push_back(site);
    }
    write_opal_asset(asset, folder_ / "a.vdb");
    const OpalAsset back = read(folder_ / "a.vdb");
    ASSERT_EQ(back.sites.size(), asset.sites.size());
    for (std::size_t i = 0; i < asset.sites.size(); ++i) ASSERT_EQ(back.sites[i].position_mm, asset.sites[i].position_mm);

    // From P alone: a 32-bit offset in a voxel, half a unit in the last place of 0.5 along each axis (the float below 0.5 is
    // 2^-25 away).
    RawOpalFile raw = read_raw_opal_file(folder_ / "a.vdb");
    const auto points = openvdb::gridPtrCast<openvdb::points::PointDataGrid>(raw.find("sites"));
    openvdb::points::dropAttribute(points->tree(), "position_mm");
    const OpalAsset rounded = asset_from_raw(raw, "rounded.vdb", {}, notices_);
    double largest_mm = 0.0;
    for (std::size_t i = 0; i < asset.sites.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            largest_mm = std::max(largest_mm, std::abs(rounded.sites[i].position_mm[axis] - asset.sites[i].position_mm[axis]));
    EXPECT_GT(largest_mm, 0.0);
    EXPECT_LE(largest_mm, 0x1p-26 * points->voxelSize().x() * 1.01);
    RecordProperty("largest_error_mm", std::to_string(largest_mm * 1.0e9) + "e-9");
}

TEST_F(AssetGrids, SitesThatAnotherProgramMovedStayMoved) {
    write_opal_asset(two_grain_ball(), folder_ / "a.vdb");
    RawOpalFile raw = read_raw_opal_file(folder_ / "a.vdb");
    const auto points = openvdb::gridPtrCast<openvdb::points::PointDataGrid>(raw.find("sites"));
    for (auto leaf = points->tree().beginLeaf(); leaf; ++leaf) {
        openvdb::points::AttributeWriteHandle<openvdb::Vec3f> offset(leaf->attributeArray("P"));
        for (openvdb::Index i = 0; i < offset.size(); ++i) offset.set(i, openvdb::Vec3f(0.25f));
    }
    const OpalAsset moved = asset_from_raw(raw, "moved.vdb", {}, notices_);
    for (const Site& site : moved.sites) {
        const openvdb::Vec3d index = points->worldToIndex(site.position_mm);
        EXPECT_NEAR(index.x() - std::round(index.x()), 0.25, 1e-6);
    }
}

TEST_F(AssetGrids, OrientationsThatTheSeedDoesNotGiveAreListed) {
    OpalAsset asset = two_grain_ball();
    asset.grain_orientations = {{0.6f, 0.0f, 0.8f, 0.0f}, {0.0f, 0.0f, 0.70710678f, 0.70710678f}};
    write_opal_asset(asset, folder_ / "listed.vdb", {{OutputGrid::grain_id, OutputGrid::shape}, false});
    const OpalAsset back = read(folder_ / "listed.vdb");
    EXPECT_TRUE(notices_.empty());
    ASSERT_EQ(back.num_grains(), 2u);
    for (std::size_t g = 0; g < 2; ++g)
        for (int c = 0; c < 4; ++c) EXPECT_EQ(back.grain_orientations[g][c], asset.grain_orientations[g][c]);

    write_opal_asset(asset, folder_ / "whole.vdb");
    RawOpalFile raw = read_raw_opal_file(folder_ / "whole.vdb");
    raw.grids.pop_back();
    asset_from_raw(raw, "resaved.vdb", {}, notices_);
    EXPECT_TRUE(contains(notices_, "the sites, which held the orientations, are not there"));
}

TEST_F(AssetGrids, BrokenFieldsAreNamedByGridAndVoxel) {
    const auto read_with = [&](const openvdb::GridBase::Ptr& grid, const char* name) {
        write_opal_asset(two_grain_ball(), folder_ / "a.vdb");
        RawOpalFile raw = read_raw_opal_file(folder_ / "a.vdb");
        grid->setName(name);
        raw.grids.insert(raw.grids.begin() + 2, grid);
        return asset_from_raw(raw, "bad.vdb", {}, notices_);
    };
    auto negative = ball_fog(1.0f, 0.2);
    negative->tree().setValueOn({1, 2, 3}, -0.5f);
    EXPECT_INPUT_ERROR(read_with(negative, "sigma_s_mie"),
                       "bad.vdb: grid sigma_s_mie: voxel [1, 2, 3] holds -0.5; allowed: numbers from 0");
    EXPECT_NO_THROW(read_with(negative, "weight"));
    auto broken = ball_fog(1.0f, 0.2);
    broken->tree().setValueOn({4, 5, 6}, std::nanf(""));
    EXPECT_INPUT_ERROR(read_with(broken, "sigma_a_scale"), "bad.vdb: grid sigma_a_scale: voxel [4, 5, 6] holds nan");
    EXPECT_INPUT_ERROR(read_with(broken, "weight"), "bad.vdb: grid weight: voxel [4, 5, 6] holds nan");
    EXPECT_INPUT_ERROR(read_with(openvdb::Int32Grid::create(1), "sigma_a_scale"),
                       "grid sigma_a_scale has type int32; allowed: float");
    auto turned = ball_fog(1.0f, 0.2);
    turned->transform().preRotate(0.3);
    EXPECT_INPUT_ERROR(read_with(turned, "sigma_a_scale"), "grid sigma_a_scale: its transform is not a uniform scale");
}

TEST_F(AssetGrids, CheckFindsUncoveredVoxelsAndTwinsThatDiffer) {
    OpalAsset asset = two_grain_ball();
    asset.sigma_a_scale = ball_fog(1.5f, 0.1);
    asset.sigma_a_scale->tree().setValueOff({3, 4, 5}, 0.0f);
    write_opal_asset(asset, folder_ / "a.vdb");
    EXPECT_TRUE(
        contains(check_opal_asset(folder_ / "a.vdb").errors, "grid sigma_a_scale: has no value at 1 of grain_id's voxels"));

    write_opal_asset(two_grain_ball(), folder_ / "twins.vdb", {WriteOpalOptions().grids, true});
    RawOpalFile raw = read_raw_opal_file(folder_ / "twins.vdb");
    openvdb::gridPtrCast<openvdb::FloatGrid>(raw.find("grain_id_float"))->tree().setValueOn({1, 1, 1}, 7.0f);
    const auto extra = openvdb::FloatGrid::create(0.0f);
    extra->setName("sigma_a_scal");
    raw.grids.insert(raw.grids.begin(), extra);
    openvdb::io::File file((folder_ / "changed.vdb").string());
    file.write(raw.grids, raw.metadata);
    file.close();
    const AssetCheck check = check_opal_asset(folder_ / "changed.vdb");
    EXPECT_TRUE(contains(check.errors, "grid grain_id_float: differs from grain_id"));
    EXPECT_TRUE(
        contains(check.advice, "grid sigma_a_scal is not part of an opal and is left alone; did you mean 'sigma_a_scale'?"));
}

TEST_F(AssetGrids, LabelsFromElsewhereAreValidWithAdvice) {
    write_foreign(folder_ / "ids.vdb", two_grain_ball().grain_id, "grain_id");
    const AssetCheck check = check_opal_asset(folder_ / "ids.vdb");
    EXPECT_TRUE(check.errors.empty()) << check.errors.front();
    EXPECT_TRUE(contains(check.advice, "made elsewhere"));
    EXPECT_TRUE(contains(check.advice, "the surface was made from the labelled voxels"));
    EXPECT_TRUE(contains(check.advice, "orientations were drawn from seed 1"));
}

TEST_F(AssetGrids, FieldsAreSummarizedOverTheShape) {
    const OpalAsset asset = two_grain_ball();
    // 1 in the half x < 0 and 3 in the other, 100 outside the ball of radius 2: the mean inside is 2 but for the voxels at x = 0.
    const auto field = openvdb::FloatGrid::create(0.0f);
    field->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
    for (const openvdb::Coord& voxel : openvdb::CoordBBox(openvdb::Coord(-25), openvdb::Coord(25))) {
        const double radius_mm = 0.1 * voxel.asVec3d().length();
        field->tree().setValueOn(voxel, radius_mm > 2.0 ? 100.0f : voxel.x() < 0 ? 1.0f : voxel.x() > 0 ? 3.0f : 2.0f);
    }
    const FieldSummary summary = summarize_field(*field, asset.shape);
    EXPECT_EQ(summary.min, 1.0f);
    EXPECT_EQ(summary.max, 100.0f);
    EXPECT_NEAR(summary.mean, 2.0, 1e-9);
}

}  // namespace
}  // namespace opal
