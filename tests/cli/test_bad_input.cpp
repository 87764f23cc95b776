// SPDX-License-Identifier: Apache-2.0
#include <openvdb/openvdb.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "../formats/expect_error.h"
#include "../renderer/small_opal.h"
#include "formats/opal_asset.h"
#include "formats/opal_file_checksum.h"
#include "run_program.h"

namespace opal {
namespace {

class BadInput : public testing::Test {
  protected:
    BadInput() {
        write("good.toml", "[shape]\nkind = \"sphere\"\nsize_mm = 4.0\n[grains]\nnum_sites = 20\nvoxel_size_mm = 0.2\n");
        SmallOpal small;
        small.voxel_mm = 0.3;
        write_opal_asset(small.make(), folder_ / "opal.vdb");
        write("scene.toml", "[render]\nwidth = 32\nheight = 24\nsamples = 2\n[[object]]\nkind = \"opal\"\nfile = \"opal.vdb\"\n");
    }

    void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
    std::string at(const std::string& name) const { return (folder_ / name).string(); }
    std::string build(const std::string& recipe, const std::string& extra = "") const {
        return opal_model + " build " + at(recipe) + " -o " + at("out.vdb") + " " + extra;
    }
    std::string render(const std::string& scene, const std::string& extra = "") const {
        return opal_render + " " + at(scene) + " -o " + at("out.exr") + " " + extra;
    }
    /// Nothing of an output may be left after a failure, not even a temporary file.
    void expect_nothing_written(std::size_t files_before) const { EXPECT_EQ(count_files((folder_ / "").string()), files_before); }

    ScratchFolder folder_;
};

TEST_F(BadInput, Recipe) {
    write("text.toml", "this is not TOML\n");
    write("zero_sites.toml", "[shape]\nkind = \"sphere\"\n[grains]\nnum_sites = 0\n");
    write("wrong_type.toml", "[shape]\nkind = \"sphere\"\n[crystal]\nn_sphere = \"glass\"\n");
    write("not_a_number.toml", "[shape]\nkind = \"sphere\"\n[crystal]\nn_sphere = nan\n");
    write("negative.toml", "[shape]\nkind = \"sphere\"\n[base_color]\nsigma_a_per_mm = -0.1\n");
    write("probability.toml", "[shape]\nkind = \"sphere\"\n[grains]\nsintering = { probability = 1.01 }\n");
    write("typo.toml", "[shape]\nkind = \"sphere\"\n[crystal]\nsphere_diametre_nm = 250\n");
    write("absorber.toml", "[shape]\nkind = \"sphere\"\n[base_color]\nabsorber = \"missing.csv\"\n");
    const std::size_t files = count_files((folder_ / "").string());
    expect_failure(build("nowhere.toml"), 2, "nowhere.toml: no such file");
    expect_failure(build("text.toml"), 2, "text.toml:1:");
    expect_failure(build("zero_sites.toml"), 2, "zero_sites.toml:4:13: grains.num_sites: 0 is out of range; allowed: 1 to");
    expect_failure(
        build("wrong_type.toml"), 2,
        "wrong_type.toml:4:12: crystal.n_sphere: 'glass' is not a known material; allowed: a number from 1 to 4, silica, water");
    expect_failure(build("not_a_number.toml"), 2, "not_a_number.toml:4:12: crystal.n_sphere: nan is out of range");
    expect_failure(build("negative.toml"), 2, "negative.toml:4:18: base_color.sigma_a_per_mm: -0.1 is out of range");
    expect_failure(build("probability.toml"), 2,
                   "probability.toml:4:29: grains.sintering.probability: 1.01 is out of range; allowed: 0 to 1");
    expect_failure(build("typo.toml"), 2,
                   "typo.toml:4:1: unknown key 'crystal.sphere_diametre_nm'; did you mean 'sphere_diameter_nm'?");
    expect_failure(build("absorber.toml"), 2, "missing.csv: no such file");
    expect_failure(build("good.toml", "--set grains.num_sites=-3"), 2,
                   "--set grains.num_sites=-3: grains.num_sites: -3 is out of range");
    expect_nothing_written(files);
}

TEST_F(BadInput, Mesh) {
    write("open.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nf 1 3 2\nf 1 2 4\nf 1 4 3\n");
    write("open.toml", "[shape]\nkind = \"mesh\"\nfile = \"open.obj\"\n");
    write("missing.toml", "[shape]\nkind = \"mesh\"\nfile = \"missing.obj\"\n");
    write("garbage.ply", "ply\nthis goes nowhere\n");
    write("garbage.toml", "[shape]\nkind = \"mesh\"\nfile = \"garbage.ply\"\n");
    const std::size_t files = count_files((folder_ / "").string());
    expect_failure(build("open.toml"), 2, "open.obj");
    expect_failure(build("open.toml"), 2, "closed");
    expect_failure(build("missing.toml"), 2, "missing.obj");
    expect_failure(build("garbage.toml"), 2, "garbage.ply");
    expect_nothing_written(files);
}

TEST_F(BadInput, ModelCommandLine) {
    expect_failure(opal_model + " build /dev/zero -o " + at("out.vdb"), 2, "is a device, not a file");
    expect_failure(opal_model + " biuld", 2, "opal-model: error: ");
    expect_failure(opal_model + " build " + at("good.toml"), 2, "--output");
    expect_failure(opal_model + " build " + at("good.toml") + " -o " + at("out.txt"), 2, ".vdb");
    expect_failure(opal_model + " build " + at("good.toml") + " -o " + at("no/such/folder/out.vdb"), 2, "does not exist");
    expect_failure(opal_model + " build " + at("good.toml") + " -o /proc/out.vdb", 2, "cannot be written");
    expect_failure(build("good.toml", "--colour red"), 2, "--colour");
    expect_failure(build("good.toml", "--for " + at("no_scene.toml")), 2, "no_scene.toml: no such file");
    expect_failure(build("good.toml", "--for " + at("good.toml")), 2, "good.toml:");
    expect_failure(build("good.toml", "--for " + at("scene.toml") + " --for-pixels 0"), 2, "--for-pixels");
    expect_failure(build("good.toml", "--for " + at("scene.toml") + " --for-pixels nan"), 2,
                   "--for-pixels: nan is not a number from 0.01 to 100");
    expect_failure(build("good.toml", "--quality final"), 2, "--quality requires --for");
    expect_failure(build("good.toml", "--for " + at("scene.toml") + " --quality finest"), 2, "finest");
    expect_failure(opal_model + " info " + at("good.toml"), 2, "not a complete .vdb file");
    expect_failure(opal_model + " check " + at("nothing.vdb"), 2, "no such file");
}

TEST_F(BadInput, FullDisk) {
    const std::size_t files = count_files((folder_ / "").string());
    // A limit on the size of files fails the way a full disk does: a short write, then an error.
    expect_failure("ulimit -f 4; " + build("good.toml"), 1, "writing failed");
    expect_failure("ulimit -f 1; " + render("scene.toml"), 1, "writing failed");
    expect_nothing_written(files);
}

TEST_F(BadInput, Opal) {
    openvdb::FloatGrid::Ptr fog = openvdb::FloatGrid::create(0.0f);
    fog->setName("density");
    openvdb::io::File file(at("fog.vdb"));
    file.write({fog});
    file.close();
    write("text.vdb", "no opal\n");
    std::filesystem::copy_file(at("opal.vdb"), at("cut.vdb"));
    std::filesystem::resize_file(at("cut.vdb"), std::filesystem::file_size(at("cut.vdb")) / 2);
    const std::size_t files = count_files((folder_ / "").string());
    expect_failure(render("scene.toml", "--set object.0.file=" + at("gone.vdb")), 2, "gone.vdb: no such file");
    expect_failure(render("scene.toml", "--set object.0.file=" + at("fog.vdb")), 2,
                   "fog.vdb: no grid named grain_id (found: density)");
    expect_failure(render("scene.toml", "--set object.0.file=" + at("text.vdb")), 2, "text.vdb: not a complete .vdb file");
    expect_failure(render("scene.toml", "--set object.0.file=" + at("cut.vdb")), 2, "cut.vdb: not a complete .vdb file");
    expect_nothing_written(files);
}

/// Whatever byte is wrong, it is noticed before it can do harm.
TEST_F(BadInput, DamagedOpal) {
    std::ifstream file(folder_ / "opal.vdb", std::ios::binary);
    const std::string good((std::istreambuf_iterator<char>(file)), {});
    std::vector<std::string> notices;
    // The first bytes say that it is a .vdb of this kind at all; from 30 on, the checksum and what it covers.
    for (std::size_t i = 30; i < good.size(); i += i < 2000 ? 7 : 1 + good.size() / 200) {
        std::string damaged = good;
        damaged[i] = char(damaged[i] ^ 0x10);
        write("damaged.vdb", damaged);
        EXPECT_INPUT_ERROR(read_opal_asset(folder_ / "damaged.vdb", {}, notices),
                           "damaged.vdb: not a complete .vdb file, or a damaged one: its checksum does not fit its content");
    }
    for (const std::size_t i : {0, 8, 9, 12, 20, 21, 29}) {
        std::string damaged = good;
        damaged[i] = char(damaged[i] ^ 0x10);
        write("damaged.vdb", damaged);
        try {
            read_opal_asset(folder_ / "damaged.vdb", {}, notices);
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("damaged.vdb: "), std::string::npos) << error.what();
        }
    }
}

/// Nothing but the recipe decides the bytes; other programs' files have no checksum and are read as they are.
TEST_F(BadInput, OpalsAreTheSameBytes) {
    const OpalAsset asset = SmallOpal().make();
    write_opal_asset(asset, folder_ / "a.vdb");
    write_opal_asset(asset, folder_ / "b.vdb");
    std::ifstream a(folder_ / "a.vdb", std::ios::binary), b(folder_ / "b.vdb", std::ios::binary);
    const std::string bytes_a((std::istreambuf_iterator<char>(a)), {}), bytes_b((std::istreambuf_iterator<char>(b)), {});
    EXPECT_TRUE(bytes_a == bytes_b);
    openvdb::io::File again(at("again.vdb"));
    again.write({asset.grain_id});
    again.close();
    EXPECT_EQ(look_at_checksum(folder_ / "again.vdb"), Checksum::none);
}

/// One error is one line, whatever a name holds.
TEST_F(BadInput, LineBreaksInNames) {
    const std::string name = "'" + at("no\nsuch\tfile.toml") + "'";
    expect_failure(opal_render + " " + name + " -o " + at("out.exr"), 2, "no\\nsuch\\tfile.toml: no such file");
    expect_failure(opal_model + " build " + name + " -o " + at("out.vdb"), 2, "no\\nsuch\\tfile.toml: no such file");
    const ProgramResult result = run_program(opal_model + " info " + name);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    std::filesystem::copy_file(at("opal.vdb"), at("two\nlines.vdb"));
    const ProgramResult check = run_program(opal_model + " check '" + at("two\nlines.vdb") + "'");
    EXPECT_EQ(check.exit_code, 0);
    EXPECT_NE(check.out.find("two\\nlines.vdb: is a valid opal\n"), std::string::npos) << check.out;
}

TEST_F(BadInput, Scene) {
    write("typo.toml", "[render]\nsampels = 3\n[[object]]\nkind = \"opal\"\nfile = \"opal.vdb\"\n");
    write("nan.toml", "[camera]\nposition_mm = [0, nan, 1]\n[[object]]\nkind = \"opal\"\nfile = \"opal.vdb\"\n");
    write("environment.toml", "[environment]\nfile = \"sky.exr\"\n[[object]]\nkind = \"opal\"\nfile = \"opal.vdb\"\n");
    const std::size_t files = count_files((folder_ / "").string());
    expect_failure(render("typo.toml"), 2, "typo.toml:2:1: unknown key 'render.sampels'; did you mean 'samples'?");
    expect_failure(render("nan.toml"), 2, "nan.toml:2:15: camera.position_mm: nan is out of range");
    expect_failure(render("environment.toml"), 2, "sky.exr: no such image file");
    expect_failure("CUDA_VISIBLE_DEVICES= " + render("scene.toml", "--device cuda"), 2, "; allowed: auto, cpu");
    expect_failure(render("scene.toml", "--time soon"), 2, "--time soon: expected");
    expect_failure(render("scene.toml", "--spp 0"), 2, "--spp");
    expect_failure(render("scene.toml", "--seed -1"), 2, "--seed");
    expect_failure(render("scene.toml", "--set object.99999999999999999999999.file=x"), 2, "there are 1 entries");
    expect_failure(render("scene.toml", "--stats " + at("out.exr")), 2, "same file as the picture");
    expect_failure(opal_render + " " + at("scene.toml") + " -o " + at("out.png"), 2, "must end in .exr");
    expect_failure(opal_render + " " + at("scene.toml") + " -o " + at("none/out.exr"), 2, "does not exist");
    expect_nothing_written(files);
}

TEST_F(BadInput, HelpAndVersionSucceed) {
    for (const std::string& program : {opal_model, opal_render})
        for (const char* flag : {" --help", " --version"}) {
            const ProgramResult result = run_program(program + flag);
            EXPECT_EQ(result.exit_code, 0);
            EXPECT_FALSE(result.out.empty());
        }
    EXPECT_NE(run_program(opal_render + " --help").out.find("mm"), std::string::npos);
}

TEST_F(BadInput, GoodInputStillWorks) {
    EXPECT_EQ(run_program(build("good.toml")).exit_code, 0);
    EXPECT_EQ(run_program(opal_model + " check " + at("out.vdb")).exit_code, 0);
    EXPECT_EQ(run_program(render("scene.toml", "--stats " + at("stats.json"))).exit_code, 0);
    EXPECT_TRUE(std::filesystem::exists(at("out.exr")));
    EXPECT_TRUE(std::filesystem::exists(at("out.png")));
    EXPECT_TRUE(std::filesystem::exists(at("stats.json")));
}

}  // namespace
}  // namespace opal
