// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "expect_error.h"
#include "formats/illuminant.h"
#include "formats/metals.h"

namespace opal {
namespace {

struct Measured {
    double wavelength_nm, n, k;
};

/// As refractiveindex.info lists the papers named in metals.h.
const std::vector<Measured> measured_gold = {
    {354.2, 1.50, 1.866}, {367.9, 1.48, 1.895}, {381.5, 1.46, 1.933}, {397.4, 1.47, 1.952}, {413.3, 1.46, 1.958},
    {430.5, 1.45, 1.948}, {450.9, 1.38, 1.914}, {471.4, 1.31, 1.849}, {495.9, 1.04, 1.833}, {520.9, 0.62, 2.081},
    {548.6, 0.43, 2.455}, {582.1, 0.29, 2.863}, {616.8, 0.21, 3.272}, {659.5, 0.14, 3.697}, {704.5, 0.13, 4.103},
    {756.0, 0.14, 4.542}, {821.1, 0.16, 5.083}, {892.0, 0.17, 5.663}};

/// The tolerances are the errors that the fits state, rounded up to a tenth of a per cent.
TEST(Metals, NormalReflectanceAsMeasured) {
    struct Row {
        const char* metal;
        Measured at;
        double tolerance;
    };
    const std::vector<Row> rows = {
        {"gold", {450.9, 1.38, 1.914}, 0.004},   {"gold", {548.6, 0.43, 2.455}, 0.004},   {"gold", {704.5, 0.13, 4.103}, 0.004},
        {"silver", {413.3, 0.05, 2.275}, 0.004}, {"silver", {548.6, 0.06, 3.586}, 0.004}, {"silver", {756.0, 0.03, 5.242}, 0.004},
        {"copper", {450.9, 1.24, 2.397}, 0.007}, {"copper", {548.6, 1.02, 2.577}, 0.007}, {"copper", {659.5, 0.22, 3.747}, 0.007},
        {"rhodium", {400.0, 1.41, 4.20}, 0.002}, {"rhodium", {539.1, 1.94, 4.94}, 0.002}, {"rhodium", {729.3, 2.42, 6.33}, 0.002},
    };
    for (const Row& row : rows)
        EXPECT_NEAR(normal_reflectance(MetalIndex::of_metal(row.metal).at(row.at.wavelength_nm)),
                    normal_reflectance({row.at.n, row.at.k}), row.tolerance)
            << row.metal << " at " << row.at.wavelength_nm << " nm";
}

/// The colour of a mirror of gold in daylight differs from that of the measured table by less than the eye can tell.
TEST(Metals, ColorOfGoldInDaylight) {
    SampledSpectrum measured, fitted;
    const MetalIndex gold = MetalIndex::of_metal("gold");
    for (const Measured& row : measured_gold) {
        measured.wavelength_nm.push_back(row.wavelength_nm);
        measured.value.push_back(normal_reflectance({row.n, row.k}));
    }
    for (int i = 0; i < colorimetric_samples; ++i) {
        fitted.wavelength_nm.push_back(colorimetric_min_nm + i);
        fitted.value.push_back(normal_reflectance(gold.at(colorimetric_min_nm + i)));
    }
    const SampledSpectrum daylight = illuminant_spectrum(IlluminantKind::d65);
    const Xyz white = xyz_of(daylight), color = xyz_of(fitted, daylight);
    EXPECT_LT(delta_e_76(lab_from_xyz(color, white), lab_from_xyz(xyz_of(measured, daylight), white)), 1.0);
    const Rgb3d rgb = linear_srgb_from_xyz(color);
    EXPECT_GT(rgb.r, rgb.g);
    EXPECT_GT(rgb.g, rgb.b);
}

TEST(Metals, AbsorbAtEveryWavelength) {
    for (const std::string& name : metal_names())
        for (double wavelength_nm = 360.0; wavelength_nm <= 830.0; wavelength_nm += 1.0) {
            const ComplexIndex index = MetalIndex::of_metal(name).at(wavelength_nm);
            EXPECT_GT(index.n, 0.0) << name << " at " << wavelength_nm;
            EXPECT_GT(index.k, 1.0) << name << " at " << wavelength_nm;
        }
}

TEST(Metals, OfATable) {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("opal_metal_" + std::to_string(getpid()) + ".csv");
    std::ofstream(path) << "# test\nwavelength_nm,n,k\n400,1,2\n600;2;4\n";
    const MetalIndex metal = MetalIndex::from_name(path.string());
    EXPECT_DOUBLE_EQ(metal.at(500.0).n, 1.5);
    EXPECT_DOUBLE_EQ(metal.at(500.0).k, 3.0);
    EXPECT_DOUBLE_EQ(metal.at(700.0).k, 4.0);
    std::ofstream(path) << "400,1,2\n600,0,4\n";
    EXPECT_INPUT_ERROR(MetalIndex::from_csv(path), ".csv:2: n 0, k 4; allowed");
    std::ofstream(path) << "400,1,2\n300,1,4\n";
    EXPECT_INPUT_ERROR(MetalIndex::from_csv(path), "wavelengths must increase");
    std::ofstream(path) << "400,1,2\n";
    EXPECT_INPUT_ERROR(MetalIndex::from_csv(path), "at least 2");
    std::filesystem::remove(path);
    EXPECT_INPUT_ERROR(MetalIndex::from_name("golt"), "did you mean 'gold'?");
}

}  // namespace
}  // namespace opal
