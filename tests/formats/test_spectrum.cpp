// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "expect_error.h"
#include "formats/cie_tables.h"
#include "formats/spectrum.h"
#include "formats/units.h"

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

TEST(Spectrum, ResamplingIsCubicAndNeverOvershoots) {
    // A smooth band sampled every 20 nm: the cubic is far nearer than straight lines, whose error is h^2/8 |f''| <= 0.0555.
    const auto band = [](double nm) { return std::exp(-0.5 * std::pow((nm - 560.0) / 30.0, 2)); };
    SampledSpectrum coarse;
    for (double nm = 340.0; nm <= 860.0; nm += 20.0) {
        coarse.wavelength_nm.push_back(nm);
        coarse.value.push_back(band(nm));
    }
    const SampledSpectrum fine = resample_spectrum(coarse);
    ASSERT_EQ(fine.value.size(), 95u);
    double cubic_error = 0.0, linear_error = 0.0;
    for (std::size_t i = 0; i < fine.value.size(); ++i) {
        cubic_error = std::max(cubic_error, std::abs(fine.value[i] - band(fine.wavelength_nm[i])));
        linear_error = std::max(linear_error, std::abs(coarse.at(fine.wavelength_nm[i]) - band(fine.wavelength_nm[i])));
    }
    EXPECT_LT(cubic_error, 0.5 * linear_error);

    // A step with zeros: an ordinary cubic spline would swing below zero and above one.
    const SampledSpectrum step =
        resample_spectrum({{400.0, 450.0, 500.0, 520.0, 540.0, 600.0, 700.0}, {0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0}});
    for (const double value : step.value) {
        EXPECT_GE(value, 0.0);
        EXPECT_LE(value, 1.0);
    }
    EXPECT_EQ(step.at(400.0), 0.0);
    EXPECT_EQ(step.at(820.0), 0.0);
    EXPECT_EQ(step.at(520.0), 1.0);
    EXPECT_DOUBLE_EQ(resample_spectrum({{400.0, 800.0}, {1.0, 3.0}}).at(500.0), 1.5);
}

TEST(Spectrum, WhatIsWeakAtTheReferenceIsScaledElsewhere) {
    const std::string path = write_file("400,0\n500,0\n560,0.001\n600,0.2\n650,1\n700,0.1\n").string();
    EXPECT_INPUT_ERROR(absorber_spectrum(path, 0.25),
                       "too little for sigma_a_per_mm to scale it there; set sigma_a_reference_nm, e.g. to 650");
    const SampledSpectrum scaled = absorber_spectrum(path, 0.25, 650.0);
    EXPECT_NEAR(scaled.at(650.0), 0.25, 1e-12);
    EXPECT_EQ(absorber_spectrum(path, 0.0).at(650.0), 0.0);
    EXPECT_INPUT_ERROR(absorber_spectrum(write_file("400,0\n500,0\n").string(), 1.0), "is zero from 360 to 830 nm");
}

/// Hue in degrees (0 red, 120 green, 240 blue) of D65 through `thickness_mm`, in linear sRGB.
double transmitted_hue_deg(const SampledSpectrum& sigma_a_per_mm, double thickness_mm) {
    double xyz[3] = {};
    for (int i = 0; i <= 470; ++i) {
        const double wavelength_nm = 360.0 + i, position = (wavelength_nm - 300.0) / 5.0;
        const auto n = std::min(std::size_t(position), std::size_t(105));
        const double t = position - double(n);
        const double light = (1.0 - t) * double(cie_d65_5nm[n]) + t * double(cie_d65_5nm[n + 1]);
        const double through = light * std::exp(-sigma_a_per_mm.at(wavelength_nm) * thickness_mm);
        xyz[0] += through * double(cie_1931_observer[i].x);
        xyz[1] += through * double(cie_1931_observer[i].y);
        xyz[2] += through * double(cie_1931_observer[i].z);
    }
    // IEC 61966-2-1.
    const double r = 3.2406 * xyz[0] - 1.5372 * xyz[1] - 0.4986 * xyz[2];
    const double g = -0.9689 * xyz[0] + 1.8758 * xyz[1] + 0.0415 * xyz[2];
    const double b = 0.0557 * xyz[0] - 0.2040 * xyz[1] + 1.0570 * xyz[2];
    const double hue_deg = units::deg_from_rad(std::atan2(std::sqrt(3.0) * (g - b), 2.0 * r - g - b));
    return hue_deg < 0.0 ? hue_deg + 360.0 : hue_deg;
}

TEST(Spectrum, BuiltinAbsorbersHaveTheirColors) {
    for (const double sigma_a_per_mm : {0.05, 0.15}) {
        const auto hue_deg = [&](const char* name) { return transmitted_hue_deg(absorber_spectrum(name, sigma_a_per_mm), 5.0); };
        EXPECT_GT(hue_deg("iron-oxide"), 5.0) << "redder than orange red";
        EXPECT_LT(hue_deg("iron-oxide"), 45.0) << "yellower than orange";
        EXPECT_GT(hue_deg("light-blue-dye"), 180.0) << "greener than cyan";
        EXPECT_LT(hue_deg("light-blue-dye"), 240.0) << "more violet than blue";
        EXPECT_GT(hue_deg("pink-dye"), 280.0) << "bluer than purple";
        EXPECT_LT(hue_deg("pink-dye"), 350.0) << "as good as red";
    }
}

TEST(Spectrum, BuiltinAbsorbersFollowTheirSources) {
    // Hematite in silica, computed in the Rayleigh limit: 4.38 times the value of 550 nm at 400 nm, 0.15 times at 650 nm (0.206,
    // 0.047 and 0.007 per cm and ppm). The fit's error is 0.84 % of the largest value, 5.4 times that at 550 nm.
    const SampledSpectrum iron = builtin_absorber("iron-oxide");
    EXPECT_NEAR(iron.at(400.0), 0.206 / 0.047, 0.0084 * 5.4 + 0.05);
    EXPECT_NEAR(iron.at(650.0), 0.007 / 0.047, 0.0084 * 5.4);
    EXPECT_NEAR(iron.at(550.0), 1.0, 1e-12);
    const auto strongest_nm = [](const SampledSpectrum& spectrum) {
        return spectrum
            .wavelength_nm[std::size_t(std::max_element(spectrum.value.begin(), spectrum.value.end()) - spectrum.value.begin())];
    };
    EXPECT_NEAR(strongest_nm(builtin_absorber("light-blue-dye")), 656.0, 5.0);
    EXPECT_NEAR(strongest_nm(builtin_absorber("pink-dye")), 543.0, 5.0);
    for (const std::string& name : builtin_absorbers())
        for (const double value : builtin_absorber(name).value) EXPECT_GE(value, 0.0) << name;
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
