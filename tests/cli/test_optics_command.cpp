// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

#include "../renderer/small_opal.h"
#include "formats/image.h"
#include "run_program.h"

namespace opal {
namespace {

struct Table {
    std::string header;
    std::vector<std::vector<double>> rows;
};

Table parse_table(const std::string& csv) {
    Table table;
    std::istringstream stream(csv);
    std::getline(stream, table.header);
    for (std::string line; std::getline(stream, line);) {
        table.rows.emplace_back();
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');) table.rows.back().push_back(std::strtod(cell.c_str(), nullptr));
    }
    return table;
}

Table run_table(const std::string& arguments) {
    const ProgramResult result = run_program(opal_optics + " " + arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    return parse_table(result.out);
}

const std::string sphere = "--sphere-diameter-nm 250 --n-sphere 1.45 --n-medium 1.333 ";

TEST(OpticsCommand, Reflectance) {
    const Table table =
        run_table("reflectance " + sphere + "--hkl 1,1,1 --layers 24 --angle-deg 0 --wavelength-nm 520:640:0.5 --model two-beam");
    EXPECT_EQ(table.header, "wavelength_nm,reflectance_s,reflectance_p,reflectance");
    ASSERT_EQ(table.rows.size(), 241u);
    EXPECT_EQ(table.rows.front()[0], 520.0);
    EXPECT_EQ(table.rows.back()[0], 640.0);
    // At 579.5 nm, next to the Bragg wavelength 579.56: tanh^2(kappa t), kappa t = 12 pi |eps_G| / n_eff^2, less 1e-4 for the
    // step.
    const double x = M_PI * std::sqrt(1.5), filling = M_PI / (3.0 * std::sqrt(2.0));
    const double epsilon = (1.45 * 1.45 - 1.333 * 1.333) * filling * 3.0 * (std::sin(x) - x * std::cos(x)) / (x * x * x);
    const double n_eff = filling * 1.45 + (1.0 - filling) * 1.333;
    EXPECT_NEAR(table.rows[119][3], std::pow(std::tanh(12.0 * M_PI * epsilon / (n_eff * n_eff)), 2), 1e-4);
    for (const auto& row : table.rows) EXPECT_NEAR(row[3], 0.5 * (row[1] + row[2]), 1e-9);

    for (const char* model : {"ewald-fresnel --tolerance 1e-3", "laue", "transfer-matrix"})
        EXPECT_EQ(run_table("reflectance " + sphere + "--layers 24 --wavelength-nm 500:600:10 --model " + model).rows.size(),
                  11u);
    EXPECT_EQ(run_table("reflectance --n-sphere silica --n-medium water --thickness-um 5 --blocks 10 --angle-in inside "
                        "--angle-deg 0,30 --wavelength-nm 500:600:50 --polarization s --filling 0.6 --index-mean maxwell-garnett")
                  .header,
              "angle_deg,wavelength_nm,reflectance_s,reflectance_p,reflectance");
}

TEST(OpticsCommand, ThicknessAndLayersAreTheSameSlab) {
    // 24 planes sqrt(2/3) 250 nm apart.
    const std::string rest = "reflectance " + sphere + "--wavelength-nm 570:590:5 ";
    const Table layers = run_table(rest + "--layers 24"),
                thickness = run_table(rest + "--thickness-um " + std::to_string(24.0 * std::sqrt(2.0 / 3.0) * 0.25));
    for (std::size_t i = 0; i < layers.rows.size(); ++i) EXPECT_NEAR(layers.rows[i][3], thickness.rows[i][3], 1e-5);
}

TEST(OpticsCommand, BraggAndItsChart) {
    const ScratchFolder folder;
    const Table table = run_table("bragg " + sphere + "--hkl 1,1,1 --angle-deg 0:60:5");
    EXPECT_EQ(table.header, "angle_deg,wavelength_nm,relative_width");
    ASSERT_EQ(table.rows.size(), 13u);
    EXPECT_NEAR(table.rows[0][1], 579.564, 0.001);
    EXPECT_NEAR(table.rows[0][2], 0.01434, 0.00001);

    const std::string output = (folder / "colors.csv").string(), chart = (folder / "colors.png").string();
    const ProgramResult result = run_program(opal_optics + " bragg --sphere-diameter-nm 150:350:50 --angle-deg 0:60:20 -o " +
                                             output + " --chart " + chart);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "");
    std::ostringstream text;
    text << std::ifstream(output).rdbuf();
    const Table many = parse_table(text.str());
    EXPECT_EQ(many.header, "sphere_diameter_nm,angle_deg,wavelength_nm,relative_width");
    EXPECT_EQ(many.rows.size(), 20u);
    EXPECT_GT(read_image(chart).width, 700);
    EXPECT_EQ(count_files((folder / "").string()), 2u);
}

TEST(OpticsCommand, Mie) {
    const Table table = run_table("mie " + sphere + "--wavelength-nm 400:700:50");
    EXPECT_EQ(table.header, "wavelength_nm,size_parameter,q_sca,q_ext,g");
    ASSERT_EQ(table.rows.size(), 7u);
    EXPECT_NEAR(table.rows[0][1], M_PI * 250.0 * 1.333 / 400.0, 1e-8);
    for (const auto& row : table.rows) EXPECT_NEAR(row[2], row[3], 1e-9 * row[3]);

    const Table phase = run_table("mie " + sphere + "--wavelength-nm 500 --phase 0:180:1");
    EXPECT_EQ(phase.header, "wavelength_nm,angle_deg,phase_per_sr");
    double integral = 0.0;
    for (const auto& row : phase.rows) integral += 2.0 * M_PI * row[2] * std::sin(row[1] * M_PI / 180.0) * M_PI / 180.0;
    EXPECT_NEAR(integral, 1.0, 1e-3);
}

TEST(OpticsCommand, ColorOfSpectra) {
    const ScratchFolder folder;
    const std::string white = (folder / "white.csv").string(), green = (folder / "green.csv").string();
    std::ofstream(white) << "wavelength_nm,reflectance\n300,1\n900,1\n";
    std::ofstream(green) << "wavelength_nm,reflectance\n300,0\n499,0\n500,0.5\n560,0.5\n561,0\n900,0\n";
    const auto color = [&](const std::string& arguments) {
        const ProgramResult result = run_program(opal_optics + " color " + arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.out.substr(0, result.out.find('\n')), "X,Y,Z,x,y,r_linear,g_linear,b_linear,srgb_hex");
        return result.out.substr(result.out.find('\n') + 1);
    };
    EXPECT_NE(color(white).find("#ffffff"), std::string::npos);
    EXPECT_NE(color(white).find(",0.3127"), std::string::npos);
    EXPECT_NE(color(white + " --illuminant A --white A").find("#ffffff"), std::string::npos);
    EXPECT_NE(color(white + " --kind emission").find(",0.3333"), std::string::npos);
    EXPECT_EQ(color(white + " --illuminant A").find("#ffffff"), std::string::npos);
    for (const char* light : {"E", "blackbody:3000", "led:4000"})
        EXPECT_NE(color(white + " --illuminant " + light + " --white " + light).find("#ffffff"), std::string::npos) << light;
    std::vector<double> xyz;
    std::istringstream cells(color(green));
    for (std::string cell; std::getline(cells, cell, ',') && xyz.size() < 3;) xyz.push_back(std::stod(cell));
    EXPECT_GT(xyz[1], 2.0 * xyz[0]);
}

TEST(OpticsCommand, WhatIsWrongIsNamed) {
    const ScratchFolder folder;
    const std::string output = (folder / "out.csv").string();
    const auto refused = [&](const std::string& arguments, const std::string& part) {
        expect_failure(opal_optics + " " + arguments + " -o " + output, 2, part);
    };
    expect_failure(opal_optics, 2, "subcommand is required");
    refused("reflectance", "--layers or --thickness-um");
    refused("reflectance --layers 10 --thickness-um 3", "one thickness is enough");
    refused("reflectance --layers none", "--layers none: expected a number");
    refused("reflectance --layers 10 --hkl 1,1,0", "--hkl 1,1,0: fcc has no such reflection");
    refused("reflectance --layers 10 --hkl 1,1", "expected three whole numbers");
    refused("reflectance --layers 10 --angle-deg 0:60", "first:last:step");
    refused("reflectance --layers 10 --angle-deg 90", "allowed: 0 to 89.99");
    refused("reflectance --layers 10 --model exact", "--model");
    refused("reflectance --layers 10 --tolerance 0.1", "goes with --model ewald-fresnel only");
    refused("reflectance --layers 10 --slices 64", "goes with --model transfer-matrix only");
    refused("reflectance --layers 10 --ambient medium", "goes with --model transfer-matrix only");
    refused("reflectance --layers 3 --hkl 2,2,2 --model transfer-matrix --ambient medium", "multiple of 2");
    refused("reflectance --layers 10 --filling 0.8", "--filling 0.8");
    refused("reflectance --layers 10 --blocks 0", "--blocks 0");
    refused("reflectance --layers 10 --n-sphere silika", "did you mean 'silica'");
    refused("reflectance --layers 10 --n-sphere 0.5", "--n-sphere");
    refused("reflectance --layers 10 --n-sphere missing.csv", "missing.csv");
    refused("bragg --sphere-diameter-nm 5", "allowed: 10 to 10000");
    refused("bragg --chart chart.png", "needs ranges in both");
    refused("bragg --sphere-diameter-nm 200,300 --chart chart.jpg", "must end in .png");
    refused("mie --n-sphere silica --wavelength-nm 100", "allowed: 200 to 2500");
    refused("reflectance --layers 3 --wavelength-nm 0", "--wavelength-nm 0: 0 is out of range");
    refused("mie --phase 190", "--phase 190");
    refused("color " + output, "out.csv: no such file");
    refused("color " + output + " --illuminant F2", "--illuminant F2: not known");
    refused("color " + output + " --illuminant led:100", "allowed: 1500 to 25000");
    refused("color " + output + " --kind emission --illuminant A", "goes with --kind reflectance only");
    EXPECT_EQ(count_files((folder / "").string()), 0u);
    expect_failure(opal_optics + " bragg -o " + (folder / "none/out.csv").string(), 2, "does not exist");
    expect_failure(opal_optics + " bragg > /dev/full", 1, "standard output: writing failed");
    const ProgramResult version = run_program(opal_optics + " --version");
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_EQ(version.out.rfind("opal-optics ", 0), 0u);
    EXPECT_NE(run_program(opal_optics + " reflectance --help").out.find("degrees"), std::string::npos);
}

}  // namespace
}  // namespace opal
