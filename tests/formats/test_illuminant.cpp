// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "expect_error.h"
#include "formats/cie_tables.h"
#include "formats/illuminant.h"

namespace opal {
namespace {

/// A .csv in the temporary folder, removed at the end.
class CsvFile {
  public:
    explicit CsvFile(const std::string& text)
        : path_(std::filesystem::temp_directory_path() /
                ("opal_illuminant_" + std::to_string(getpid()) + "_" +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv")) {
        std::ofstream(path_) << text;
    }
    ~CsvFile() { std::filesystem::remove(path_); }
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

void expect_chromaticity(const SampledSpectrum& light, double x, double y, double tolerance) {
    const Chromaticity chromaticity = chromaticity_of(xyz_of(light));
    EXPECT_NEAR(chromaticity.x, x, tolerance);
    EXPECT_NEAR(chromaticity.y, y, tolerance);
    EXPECT_NEAR(xyz_of(light).y, 1.0, 1e-12);
    ASSERT_EQ(light.value.size(), std::size_t(colorimetric_samples));
    EXPECT_EQ(light.wavelength_nm.front(), 360.0);
    EXPECT_EQ(light.wavelength_nm.back(), 830.0);
}

/// Published chromaticities (CIE 015, table T.3: A 0.44758 0.40745, E 1/3 1/3; D65 0.31273 0.32902 for sums in steps of 1 nm), to a
/// unit of their last digit.
TEST(Illuminant, PublishedChromaticities) {
    expect_chromaticity(illuminant_spectrum(IlluminantKind::d65), 0.31273, 0.32902, 1.1e-5);
    expect_chromaticity(illuminant_spectrum(IlluminantKind::a), 0.44758, 0.40745, 1.1e-5);
    // The observer's three integrals differ in the fifth digit: 106.8655, 106.8569, 106.8923.
    expect_chromaticity(illuminant_spectrum(IlluminantKind::equal_energy), 1.0 / 3.0, 1.0 / 3.0, 1.0e-4);
}

TEST(Illuminant, D65PassesThroughTheStandardsValues) {
    const SampledSpectrum d65 = illuminant_spectrum(IlluminantKind::d65);
    const double scale = 100.0 / d65.at(560.0);
    for (int i = 12; i < 107; ++i) EXPECT_NEAR(scale * d65.at(300.0 + 5.0 * i), double(cie_d65_5nm[std::size_t(i)]), 1.0e-6) << i;
    EXPECT_NEAR(scale * d65.at(402.0), 82.7549 + 0.4 * (87.1204 - 82.7549), 1.0e-4);
}

/// Illuminant A is a Planckian radiator of 2856 K to 0.5 K, with the value of c2 that its equation was written with.
TEST(Illuminant, BlackbodyOf2856KelvinIsIlluminantA) {
    const SampledSpectrum planck = illuminant_spectrum(IlluminantKind::blackbody, 2856.0);
    expect_chromaticity(planck, 0.44758, 0.40745, 1.0e-4);
    const SampledSpectrum a = illuminant_spectrum(IlluminantKind::a);
    for (std::size_t i = 0; i < a.value.size(); ++i) EXPECT_NEAR(planck.value[i], a.value[i], 2.0e-3 * a.value[i]);
}

/// Wien's displacement law: the peak over the wavelength at 2.897771955e6 nm K / T.
TEST(Illuminant, BlackbodyPeaksWhereWienSays) {
    for (const double temperature_k : {4000.0, 5000.0, 6500.0, 8000.0}) {
        const double peak_nm = 2.897771955e6 / temperature_k;
        const double at_peak = planck_relative_to_560nm(peak_nm, temperature_k);
        EXPECT_GT(at_peak, planck_relative_to_560nm(peak_nm - 0.5, temperature_k));
        EXPECT_GT(at_peak, planck_relative_to_560nm(peak_nm + 0.5, temperature_k));
    }
}

TEST(Illuminant, LedHasItsColorTemperature) {
    for (const double temperature_k : {led_min_k, 2200.0, 2700.0, 4000.0, 6500.0, 10000.0, led_max_k}) {
        const SampledSpectrum led = illuminant_spectrum(IlluminantKind::led, temperature_k);
        const CorrelatedColorTemperature cct = correlated_color_temperature(chromaticity_of(xyz_of(led)));
        EXPECT_NEAR(cct.temperature_k, temperature_k, 1.0e-4 * temperature_k);
        EXPECT_NEAR(cct.duv, 0.0, 1.0e-6);
        for (const double value : led.value) EXPECT_GE(value, 0.0) << temperature_k;
        // A pump and a phosphor: a dip between them, unlike any black body. Warmer light has next to no pump.
        if (temperature_k < 2700.0) continue;
        EXPECT_LT(led.at(480.0), led.at(450.0));
        EXPECT_LT(led.at(480.0), led.at(545.0));
    }
    EXPECT_INPUT_ERROR(illuminant_spectrum(IlluminantKind::led, 1200.0), "allowed: 1500 to 25000 K");
    EXPECT_INPUT_ERROR(illuminant_spectrum(IlluminantKind::blackbody, 0.0), "0 K is not possible");
}

TEST(Illuminant, FileIsLinearBetweenAndConstantBeyondItsSamples) {
    const CsvFile csv("# a lamp\nwavelength_nm,power\n400,1\n500,3\n600,2\n");
    const SampledSpectrum lamp = illuminant_spectrum(IlluminantKind::file, 0.0, csv.path());
    EXPECT_NEAR(lamp.at(450.0) / lamp.at(400.0), 2.0, 1e-12);
    EXPECT_NEAR(lamp.at(360.0) / lamp.at(400.0), 1.0, 1e-12);
    EXPECT_NEAR(lamp.at(830.0) / lamp.at(400.0), 2.0, 1e-12);
    EXPECT_NEAR(xyz_of(lamp).y, 1.0, 1e-12);
}

TEST(Illuminant, BadFilesAreRefused) {
    EXPECT_INPUT_ERROR(illuminant_spectrum(IlluminantKind::file, 0.0, "/nowhere/lamp.csv"), "/nowhere/lamp.csv: no such file");
    const CsvFile negative("400,1\n500,-3\n");
    EXPECT_INPUT_ERROR(illuminant_spectrum(IlluminantKind::file, 0.0, negative.path()), ".csv:2: value -3 is not allowed");
    const CsvFile dark("400,0\n500,0\n");
    EXPECT_INPUT_ERROR(illuminant_spectrum(IlluminantKind::file, 0.0, dark.path()), "no light between 360 and 830 nm");
}

}  // namespace
}  // namespace opal
