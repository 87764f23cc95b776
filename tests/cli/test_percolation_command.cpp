// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <sstream>

#include "../renderer/small_opal.h"
#include "formats/image.h"
#include "run_program.h"

namespace opal {
namespace {

class PercolationCommand : public testing::Test {
  protected:
    PercolationCommand() {
        std::ofstream(folder_ / "recipe.toml") << "[shape]\nkind = \"sphere\"\nsize_mm = 4.0\n[grains]\nnum_sites = 800\n"
                                                  "sintering = { graph = \"delaunay\", probability = 0.12 }\n";
    }
    std::string at(const std::string& name) const { return (folder_ / name).string(); }
    std::string command(const std::string& rest) const { return opal_model + " percolation " + at("recipe.toml") + " " + rest; }
    std::string content(const std::string& name) const {
        std::ostringstream text;
        text << std::ifstream(folder_ / name).rdbuf();
        return text.str();
    }

    ScratchFolder folder_;
};

TEST_F(PercolationCommand, WritesTheCurveAndThePlot) {
    const ProgramResult result = run_program(command("-o " + at("p.csv") + " --plot " + at("p.png") + " --threads 1"));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("threshold  p about 0."), std::string::npos) << result.out;
    const std::string csv = content("p.csv");
    for (const char* part :
         {"# graph delaunay, preference none, sites 800, hidden ", "# recipe: p 0.12, grains ", "\n# threshold 0.",
          "\np,grains,grains_per_site,largest_fraction,mean_other_size\n0,", "\n1,1,0.00125,1,0\n"})
        EXPECT_NE(csv.find(part), std::string::npos) << part << "\n" << csv.substr(0, 600);
    EXPECT_GT(read_image(folder_ / "p.png").width, 600);
    EXPECT_EQ(count_files(at("")), 3u);

    ASSERT_EQ(run_program(command("-o " + at("two.csv") + " --threads 2")).exit_code, 0);
    EXPECT_EQ(content("two.csv"), csv);
    EXPECT_EQ(
        run_program(command("-o " + at("weighted.csv") + " --set grains.sintering.preference=\\\"misorientation\\\"")).exit_code,
        0);
    EXPECT_NE(content("weighted.csv").find("weighted bonds"), std::string::npos);
}

TEST_F(PercolationCommand, RefusesWhatItCannotWrite) {
    expect_failure(command("-o " + at("p.txt")), 2, "must end in .csv");
    expect_failure(command("-o " + at("p.csv") + " --plot " + at("p.svg")), 2, "must end in .png");
    expect_failure(command("-o " + at("none/p.csv")), 2, "does not exist");
    expect_failure(command("-o " + at("p.csv") + " --set grains.sintering.grains=900"), 2, "grains.sintering.grains");
    expect_failure("ulimit -f 1; " + command("-o " + at("p.csv")), 1, "writing failed");
    EXPECT_EQ(count_files(at("")), 1u);
}

}  // namespace
}  // namespace opal
