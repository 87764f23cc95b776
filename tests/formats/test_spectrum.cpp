// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "expect_error.h"
#include "formats/spectrum.h"

namespace opal {
namespace {

std::filesystem::path write_file(const std::string& text) {
    const auto path = std::filesystem::temp_directory_path() /
                      ("opal_spectrum_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".csv");
    std::ofstream(path) << text;
    return path;
}

TEST(Spectrum, InterpolatesLinearlyAndHoldsTheEnds) {
    const SampledSpectrum spectrum{{400.0, 500.0}, {1.0, 3.0}};
    EXPECT_DOUBLE_EQ(spectrum.at(450.0), 2.0);
    EXPECT_DOUBLE_EQ(spectrum.at(300.0), 1.0);
    EXPECT_DOUBLE_EQ(spectrum.at(900.0), 3.0);
}

TEST(Spectrum, AbsorberIsScaledAt550nm) {
    const SampledSpectrum carbon = absorber_spectrum("carbon", 0.25);
    EXPECT_NEAR(carbon.at(550.0), 0.25, 1e-12);
    EXPECT_GT(carbon.at(400.0), carbon.at(700.0));
    EXPECT_NEAR(absorber_spectrum("neutral", 0.5).at(400.0), 0.5, 1e-12);
    EXPECT_INPUT_ERROR(absorber_spectrum("carbn", 1.0), "did you mean 'carbon'?");
}

TEST(Spectrum, CsvReadsAndItsErrorsAreLocated) {
    const SampledSpectrum spectrum = read_spectrum_csv(write_file("# dye\nwavelength_nm,value\n400,1\n550,2\n700,0.5\n"));
    EXPECT_DOUBLE_EQ(spectrum.at(550.0), 2.0);
    EXPECT_INPUT_ERROR(read_spectrum_csv("nothing.csv"), "nothing.csv: no such file");
    EXPECT_INPUT_ERROR(read_spectrum_csv(write_file("400,1\n390,2\n")), ":2: wavelengths must increase");
    EXPECT_INPUT_ERROR(read_spectrum_csv(write_file("400,1\n500,-2\n")), ":2: value -2 is not allowed");
    EXPECT_INPUT_ERROR(read_spectrum_csv(write_file("400,1\n500,nan\n")), ":2: value nan is not allowed");
    EXPECT_INPUT_ERROR(read_spectrum_csv(write_file("400,1\nabc\n")), ":2: expected 'wavelength_nm,value'");
    EXPECT_INPUT_ERROR(read_spectrum_csv(write_file("400,1\n")), "at least 2 are needed");
}

TEST(Spectrum, TravelsAsText) {
    const SampledSpectrum spectrum{{400.0, 512.5}, {0.1, 1.0 / 3.0}};
    const SampledSpectrum back = spectrum_from_text(spectrum_to_text(spectrum));
    EXPECT_EQ(back.wavelength_nm, spectrum.wavelength_nm);
    EXPECT_EQ(back.value, spectrum.value);
    EXPECT_INPUT_ERROR(spectrum_from_text("400:1 oops"), "broken");
    EXPECT_INPUT_ERROR(spectrum_from_text(""), "broken");
}

}  // namespace
}  // namespace opal
