// SPDX-License-Identifier: Apache-2.0
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/openvdb.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "../renderer/small_opal.h"
#include "formats/opal_asset_io.h"
#include "run_program.h"

// What other programs make of a file with every grid that opal-model can write. A client that is not installed is a visible skip.

namespace opal {
namespace {

bool installed(const std::string& program) {
    return run_program("command -v " + program).exit_code == 0;
}

class Clients : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = new ScratchFolder;
        std::ofstream(*folder_ / "recipe.toml")
            << "[shape]\nkind = \"cabochon\"\nsize_mm = [4.0, 3.0, 2.0]\n[grains]\nnum_sites = 60\nvoxel_size_mm = 0.05\n"
               "[base_color]\nsigma_a_field = { kind = \"noise\" }\nsigma_s_rayleigh_400nm_per_mm = 0.2\n"
               "sigma_s_rayleigh_field = { kind = \"layers\", scale_mm = 1.0 }\n"
               "sigma_s_mie_per_mm = 0.1\nsigma_s_mie_field = { kind = \"grains\" }\n";
        const ProgramResult built =
            run_program(opal_model + " build " + (*folder_ / "recipe.toml").string() + " -o " + opal() + " --for-blender");
        ASSERT_EQ(built.exit_code, 0) << built.err;
    }
    static void TearDownTestSuite() {
        delete folder_;
        folder_ = nullptr;
    }
    static std::string opal() { return (*folder_ / "opal.vdb").string(); }

    static ScratchFolder* folder_;
};

ScratchFolder* Clients::folder_ = nullptr;

const std::vector<std::string> grids_before_sites = {"grain_id",    "shape",           "sigma_a_scale", "sigma_s_rayleigh_400nm",
                                                     "sigma_s_mie", "orientation_rgb", "grain_id_float"};

/// Values at all active voxels of the OpenVDB grid, and the number of those.
template <typename Grid, typename Nano>
void expect_equal_values(const openvdb::GridBase::Ptr& base, const nanovdb::GridHandle<nanovdb::HostBuffer>& handle) {
    const auto grid = openvdb::gridPtrCast<Grid>(base);
    const nanovdb::NanoGrid<Nano>* nano = handle.grid<Nano>();
    ASSERT_TRUE(grid && nano) << base->getName();
    EXPECT_EQ(nano->activeVoxelCount(), grid->activeVoxelCount());
    EXPECT_NEAR(nano->voxelSize()[0], grid->voxelSize().x(), 1e-12);
    const auto values = nano->getAccessor();
    const auto same = [](const auto& a, const auto& b) {
        if constexpr (std::is_same_v<Nano, nanovdb::Vec3f>)
            return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
        else
            return a == b;
    };
    openvdb::Coord voxel;
    for (auto value = grid->cbeginValueAll(); value; ++value) {
        voxel = value.getCoord();
        ASSERT_TRUE(same(values.getValue(nanovdb::Coord(voxel.x(), voxel.y(), voxel.z())), *value)) << base->getName() << voxel;
    }
}

TEST_F(Clients, NanoVdbConvertsEveryGridBeforeTheSites) {
    const RawOpalFile raw = read_raw_opal_file(opal());
    ASSERT_EQ(raw.grids.size(), grids_before_sites.size() + 1);
    for (std::size_t n = 0; n < grids_before_sites.size(); ++n) {
        ASSERT_EQ(raw.grids[n]->getName(), grids_before_sites[n]);
        const auto handle = nanovdb::openToNanoVDB(raw.grids[n]);
        if (grids_before_sites[n] == "grain_id")
            expect_equal_values<openvdb::Int32Grid, std::int32_t>(raw.grids[n], handle);
        else if (grids_before_sites[n] == "orientation_rgb")
            expect_equal_values<openvdb::Vec3SGrid, nanovdb::Vec3f>(raw.grids[n], handle);
        else
            expect_equal_values<openvdb::FloatGrid, float>(raw.grids[n], handle);
    }
    EXPECT_EQ(raw.grids.back()->getName(), "sites");
}

TEST_F(Clients, VdbPrintReadsEverything) {
    if (!installed("vdb_print")) GTEST_SKIP() << "vdb_print is not installed (Debian: libopenvdb-tools)";
    const ProgramResult printed = run_program("vdb_print -l -m " + opal());
    EXPECT_EQ(printed.exit_code, 0) << printed.err;
    EXPECT_TRUE(printed.err.empty()) << printed.err;
    for (const std::string& name : grids_before_sites)
        EXPECT_NE(printed.out.find("Name: " + name + "\n"), std::string::npos) << name;
    for (const char* part : {"Name: sites", "opal_schema_version: 3", "units: mm", "num_sites: 60", "Tree_ptdataidx32"})
        EXPECT_NE(printed.out.find(part), std::string::npos) << part;
}

TEST_F(Clients, VdbToolWritesNanoVdb) {
    if (!installed("vdb_tool")) GTEST_SKIP() << "vdb_tool is not installed (Debian: libopenvdb-tools)";
    std::string names;
    for (const std::string& name : grids_before_sites) names += (names.empty() ? "" : ",") + name;
    const std::string nano = (*folder_ / "opal.nvdb").string();
    const ProgramResult converted = run_program("vdb_tool -read grids=" + names + " " + opal() + " -write " + nano);
    EXPECT_EQ(converted.exit_code, 0) << converted.err;
    EXPECT_EQ(converted.err.find("rror"), std::string::npos) << converted.err;
    ASSERT_TRUE(std::filesystem::exists(nano));
    EXPECT_GT(std::filesystem::file_size(nano), 100'000u);
}

TEST_F(Clients, PythonReadsFloatAndColorGrids) {
    // Debian's module belongs to Debian's Python.
    const ProgramResult read = run_program(std::string("/usr/bin/python3 ") + OPAL_CLI_TESTS + "/read_with_python.py " + opal());
    if (read.exit_code == 77 || read.exit_code == 127)
        GTEST_SKIP() << "no OpenVDB module for Python (Debian: python3-openvdb): " << read.out << read.err;
    EXPECT_EQ(read.exit_code, 0) << read.out << read.err;
}

TEST_F(Clients, AFileWithLabelsAloneIsAcceptedWithAdvice) {
    const RawOpalFile raw = read_raw_opal_file(opal());
    openvdb::io::File file((*folder_ / "labels.vdb").string());
    file.write({raw.find("grain_id")});
    file.close();
    const ProgramResult check = run_program(opal_model + " check " + (*folder_ / "labels.vdb").string());
    EXPECT_EQ(check.exit_code, 0) << check.err;
    for (const char* part :
         {"advice: made elsewhere", "advice: no level set named shape", "orientations were drawn from seed 1", "is a valid opal"})
        EXPECT_NE(check.out.find(part), std::string::npos) << part << "\n" << check.out;
    EXPECT_EQ(run_program(opal_model + " info " + (*folder_ / "labels.vdb").string()).exit_code, 0);
}

TEST_F(Clients, SitesAloneAreRefusedByTheRendererAlone) {
    const std::string sites = (*folder_ / "sites.vdb").string();
    const ProgramResult built = run_program(opal_model + " build " + (*folder_ / "recipe.toml").string() + " -o " + sites +
                                            " --set grains.voxel_size_mm=0.0001 --set 'output.grids=[\"sites\"]'");
    EXPECT_EQ(built.exit_code, 0) << built.err;
    EXPECT_NE(built.err.find("output.grids leaves them out"), std::string::npos) << built.err;
    for (const char* command : {" check ", " info ", " info --json "})
        EXPECT_EQ(run_program(opal_model + command + sites).exit_code, 0) << command;
    std::ofstream(*folder_ / "scene.toml") << "[[object]]\nkind = \"opal\"\nfile = \"sites.vdb\"\n";
    expect_failure(opal_render + " " + (*folder_ / "scene.toml").string() + " -o " + (*folder_ / "out.exr").string(), 2,
                   "sites.vdb: holds sites alone, no shape");
}

TEST_F(Clients, SitesAloneTakeLittleMemoryAtAnyResolution) {
    std::ofstream(*folder_ / "many.toml") << "[shape]\nkind = \"ellipsoid\"\n[grains]\nnum_sites = 27000\n"
                                             "[output]\ngrids = [\"sites\"]\n";
    const std::string report = (*folder_ / "report.json").string();
    for (const char* voxels : {"grains.voxel_size_mm=0.0001", "grains.resolution=64"}) {
        const ProgramResult built = run_program(opal_model + " build " + (*folder_ / "many.toml").string() + " -o " +
                                                (*folder_ / "many.vdb").string() + " --set " + voxels + " --report " + report);
        ASSERT_EQ(built.exit_code, 0) << built.err;
        const nlohmann::json json = nlohmann::json::parse(std::ifstream(report));
        EXPECT_LT(json["peak_memory_bytes"].get<double>(), 100.0e6) << voxels;
        // Nothing but what makes the sites and their grains.
        for (const char* stage : {"level_set", "labelling", "fields"}) EXPECT_FALSE(json["seconds"].contains(stage)) << stage;
        EXPECT_LT(json["seconds"]["write"].get<double>(), 0.5);
    }
}

TEST_F(Clients, TheRendererTracksFieldsAndLeavesNothingOut) {
    std::ofstream(*folder_ / "fields.toml")
        << "[render]\nwidth = 16\nheight = 12\nsamples = 4\n[[object]]\nkind = \"opal\"\nfile = \"opal.vdb\"\n";
    const ProgramResult rendered =
        run_program(opal_render + " " + (*folder_ / "fields.toml").string() + " -o " + (*folder_ / "out.exr").string() +
                    " --stats " + (*folder_ / "out.json").string());
    EXPECT_EQ(rendered.exit_code, 0) << rendered.err;
    for (const char* part : {"note:", "warning", "mean"}) EXPECT_EQ(rendered.err.find(part), std::string::npos) << rendered.err;
    std::ifstream stats(*folder_ / "out.json");
    const nlohmann::json counts = nlohmann::json::parse(stats)["counts"];
    EXPECT_EQ(counts["majorant_violations"], 0);
    EXPECT_GT(counts["scatterings"], 0);
}

}  // namespace
}  // namespace opal
