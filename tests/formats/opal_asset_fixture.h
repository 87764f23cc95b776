// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "formats/opal_asset.h"

namespace opal {

class OpalAssetTest : public testing::Test {
  protected:
    OpalAssetTest() {
        initialize_openvdb();
        std::filesystem::create_directories(folder_);
    }
    ~OpalAssetTest() override { std::filesystem::remove_all(folder_); }

    /// A ball of radius 2 mm cut into two grains by the plane x = 0.
    static OpalAsset two_grain_ball() {
        OpalAsset asset;
        asset.shape = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(2.0f, openvdb::Vec3f(0.0f), 0.1f);
        asset.grain_id = openvdb::Int32Grid::create(0);
        asset.grain_id->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
        auto accessor = asset.grain_id->getAccessor();
        for (int i = -20; i <= 20; ++i)
            for (int j = -20; j <= 20; ++j)
                for (int k = -20; k <= 20; ++k)
                    if (i * i + j * j + k * k < 400) accessor.setValueOn({i, j, k}, i < 0 ? 1 : 2);
        asset.sites = {{{-1.0, 0.0, 0.0}, 0.125f, 1}, {{1.0, 0.1, 0.2}, -0.25f, 2}, {{1.0, -0.3, 0.7}, 0.0f, 2}};
        asset.grain_orientations = {random_orientation(3, false, 1), random_orientation(3, false, 2)};
        asset.constants.sigma_a_per_mm = absorber_spectrum("carbon", 0.4);
        asset.recipe_toml = "[shape]\nkind = \"sphere\"\n";
        asset.seed = 3;
        return asset;
    }

    OpalAsset read(const std::filesystem::path& path) {
        notices_.clear();
        return read_opal_asset(path, {}, notices_);
    }

    void write_foreign(const std::filesystem::path& path, const openvdb::GridBase::Ptr& grid, const std::string& name) {
        grid->setName(name);
        openvdb::io::File file(path.string());
        file.write({grid});
        file.close();
    }

    const std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("opal_asset_test_" + std::to_string(::getpid()));
    std::vector<std::string> notices_;
};

}  // namespace opal
