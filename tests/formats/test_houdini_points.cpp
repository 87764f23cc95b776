// SPDX-License-Identifier: Apache-2.0
// What examples/houdini/README.md promises about an opal .vdb, read with OpenVDB alone.
#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/points/PointCount.h>
#include <openvdb/points/PointDataGrid.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "formats/opal_asset.h"

namespace opal {
namespace {

class HoudiniPoints : public testing::Test {
  protected:
    HoudiniPoints() {
        initialize_openvdb();
        OpalAsset asset;
        asset.shape = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0f, openvdb::Vec3f(0.0f), 0.1f);
        asset.grain_id = openvdb::Int32Grid::create(0);
        asset.grain_id->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
        for (int i = -5; i <= 5; ++i) asset.grain_id->tree().setValueOn({i, 0, 0}, i < 0 ? 1 : 2);
        asset.sites = {{{-0.5, 0.125, 0.25}, 0.125f, 1}, {{0.5, -0.25, 0.0}, -0.25f, 2}, {{0.25, 0.5, -0.5}, -2.0f, 0}};
        // Grain 1: a quarter turn about z, which takes the lattice's x axis to y. Grain 2: 120 degrees about [111].
        const float s = std::sqrt(0.5f);
        asset.grain_orientations = {{0.0f, 0.0f, s, s}, {0.5f, 0.5f, 0.5f, 0.5f}};
        asset.constants.sigma_a_per_mm = absorber_spectrum("carbon", 0.4);
        asset.recipe_toml = "[shape]\nkind = \"sphere\"\n";
        write_opal_asset(asset, path_);
        openvdb::io::File file(path_.string());
        file.open();
        metadata_ = file.getMetadata();
        sites_ = openvdb::gridPtrCast<openvdb::points::PointDataGrid>(file.readGrid("sites"));
        file.close();
    }
    ~HoudiniPoints() override { std::filesystem::remove(path_); }

    const std::filesystem::path path_ =
        std::filesystem::temp_directory_path() / ("opal_houdini_test_" + std::to_string(::getpid()) + ".vdb");
    openvdb::MetaMap::Ptr metadata_;
    openvdb::points::PointDataGrid::Ptr sites_;
};

TEST_F(HoudiniPoints, AttributesHaveTheDocumentedTypes) {
    ASSERT_TRUE(sites_);
    EXPECT_EQ(openvdb::points::pointCount(sites_->tree()), 3u);
    const std::map<std::string, std::string> documented = {{"P", "vec3s"},      {"id", "int32"},         {"grain", "int32"},
                                                           {"weight", "float"}, {"orient", "quats"},     {"pscale", "float"},
                                                           {"Cd", "vec3s"},     {"position_mm", "vec3d"}};
    const auto& descriptor = sites_->tree().cbeginLeaf()->attributeSet().descriptor();
    EXPECT_EQ(descriptor.map().size(), documented.size());
    for (const auto& [name, type] : documented) {
        const std::size_t position = descriptor.find(name);
        ASSERT_NE(position, openvdb::points::AttributeSet::INVALID_POS) << name;
        EXPECT_EQ(descriptor.valueType(position), type) << name;
        // A codec other than none would round the values.
        EXPECT_EQ(descriptor.type(position).second, "null") << name;
    }
}

TEST_F(HoudiniPoints, OrientIsXYZWAndTurnsTheLatticeIntoTheGrain) {
    namespace points = openvdb::points;
    int seen = 0;
    for (auto leaf = sites_->tree().cbeginLeaf(); leaf; ++leaf) {
        const points::AttributeHandle<openvdb::Vec3f> position(leaf->constAttributeArray("P"));
        const points::AttributeHandle<std::int32_t> grain(leaf->constAttributeArray("grain"));
        const points::AttributeHandle<openvdb::Quats> orient(leaf->constAttributeArray("orient"));
        for (auto index = leaf->beginIndexOn(); index; ++index, ++seen) {
            const openvdb::Quats q = orient.get(*index);
            const openvdb::Vec3d place_mm =
                sites_->indexToWorld(openvdb::Vec3d(position.get(*index)) + index.getCoord().asVec3d());
            if (grain.get(*index) == 1) {
                EXPECT_LT((place_mm - openvdb::Vec3d(-0.5, 0.125, 0.25)).length(), 1e-6);
                EXPECT_FLOAT_EQ(q[2], std::sqrt(0.5f));  // z, then w
                EXPECT_FLOAT_EQ(q[3], std::sqrt(0.5f));
                EXPECT_LT((q.rotateVector(openvdb::Vec3f(1, 0, 0)) - openvdb::Vec3f(0, 1, 0)).length(), 1e-6f);
            } else if (grain.get(*index) == 2) {
                EXPECT_LT((q.rotateVector(openvdb::Vec3f(1, 0, 0)) - openvdb::Vec3f(0, 1, 0)).length(), 1e-6f);
                EXPECT_LT((q.rotateVector(openvdb::Vec3f(0, 1, 0)) - openvdb::Vec3f(0, 0, 1)).length(), 1e-6f);
            } else {
                EXPECT_EQ(grain.get(*index), 0);
                EXPECT_EQ(q[3], 1.0f);  // hidden: no turn
            }
        }
    }
    EXPECT_EQ(seen, 3);
}

TEST_F(HoudiniPoints, MetadataThatBecomesDetailAttributes) {
    EXPECT_DOUBLE_EQ(metadata_->metaValue<double>("metres_per_unit"), 0.001);
    EXPECT_EQ(metadata_->metaValue<std::string>("units"), "mm");
    EXPECT_DOUBLE_EQ(metadata_->metaValue<double>("sphere_diameter_nm"), 250.0);
    EXPECT_EQ(metadata_->metaValue<std::string>("opal_recipe"), "[shape]\nkind = \"sphere\"\n");
}

}  // namespace
}  // namespace opal
