// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>

#include "formats/units.h"
#include "reference_table.h"
#include "renderer/optics/reflectance.h"

namespace opal {
namespace {

struct Peak {
    double wavelength, height, relative_width;  ///< width: full, at half height, over the peak's wavelength
};

/// The highest point of a curve given at increasing wavelengths, and its full width at half height, linear between the points.
Peak measure_peak(const std::vector<double>& wavelength, const std::vector<double>& value) {
    const std::size_t top = std::size_t(std::max_element(value.begin(), value.end()) - value.begin());
    const double half = 0.5 * value[top];
    const auto crossing = [&](std::size_t inside, std::size_t outside) {
        const double t = (value[inside] - half) / (value[inside] - value[outside]);
        return wavelength[inside] + t * (wavelength[outside] - wavelength[inside]);
    };
    std::size_t low = top, high = top;
    while (value[low - 1] > half) --low;
    while (value[high + 1] > half) ++high;
    return {wavelength[top], value[top], (crossing(high, high + 1) - crossing(low, low - 1)) / wavelength[top]};
}

/// Full-wave simulation (FDTD, Meep 1.25) of 12 layers of spheres of 1.45 in air: the file says how.
TEST(SlabReflectance, TwelveLayersAgreeWithTheFullWaveSimulation) {
    std::vector<double> wavelength, reflectance;
    auto rows = read_reference_table("fdtd_slab_111_ns1.45_nm1.0_12layers.csv");
    ASSERT_EQ(rows.size(), 201u);
    std::sort(rows.begin(), rows.end());
    ReflectanceSetup setup;
    setup.crystal.n_medium = 1.0;
    setup.layers = 12.0;
    std::vector<double> two_beam;
    for (const auto& row : rows) {
        wavelength.push_back(row[0]);
        reflectance.push_back(row[1]);
        two_beam.push_back(reflectance_at(setup, row[0] * setup.crystal.sphere_diameter_nm, 1.0).s);
    }
    const Peak expected = measure_peak(wavelength, reflectance), peak = measure_peak(wavelength, two_beam);
    RecordProperty("fdtd_height", std::to_string(expected.height));
    RecordProperty("two_beam_height", std::to_string(peak.height));
    RecordProperty("fdtd_width", std::to_string(expected.relative_width));
    RecordProperty("two_beam_width", std::to_string(peak.relative_width));
    EXPECT_NEAR(peak.height, expected.height, 0.05 * expected.height);
    EXPECT_NEAR(peak.relative_width, expected.relative_width, 0.08 * expected.relative_width);
}

/// The plane-averaged profile of whole spheres in air, without any fitted index: the same peak, but as much redder as the root of
/// the mean permittivity is above the band solver's index (mpb_fcc_L_gap.csv, 1.45 in air: 2.16924 d / (2 sqrt(2/3) d)), and the
/// side lobe that the faces of the slab make on its red side, which no model in an ambient of the mean index has.
TEST(SlabReflectance, WholeSpheresInAirMakeTheSideLobeOfTheFullWaveSimulation) {
    auto rows = read_reference_table("fdtd_slab_111_ns1.45_nm1.0_12layers.csv");
    std::sort(rows.begin(), rows.end());
    ReflectanceSetup setup;
    setup.crystal.n_medium = 1.0;
    setup.layers = 12.0;
    setup.model = ReflectanceModel::transfer_matrix;
    setup.ambient = Ambient::medium;
    const double redder = std::sqrt(setup.crystal.mean_permittivity(500.0)) / (2.16924 / (2.0 * std::sqrt(2.0 / 3.0)));
    std::vector<double> wavelength, reflectance, whole_spheres;
    double lobe_height = 0.0, lobe_wavelength = 0.0, height = 0.0, place = 0.0;
    for (const auto& row : rows) {
        wavelength.push_back(row[0]);
        reflectance.push_back(row[1]);
        whole_spheres.push_back(reflectance_at(setup, row[0] * redder * setup.crystal.sphere_diameter_nm, 1.0).s);
        if (row[0] > 2.4 && row[1] > lobe_height) lobe_height = row[1], lobe_wavelength = row[0];
        if (row[0] > 2.4 && whole_spheres.back() > height) height = whole_spheres.back(), place = row[0];
    }
    const Peak expected = measure_peak(wavelength, reflectance), peak = measure_peak(wavelength, whole_spheres);
    EXPECT_NEAR(peak.height, expected.height, 0.05 * expected.height);
    EXPECT_NEAR(peak.relative_width, expected.relative_width, 0.08 * expected.relative_width);
    EXPECT_NEAR(peak.wavelength, expected.wavelength, 0.005 * expected.wavelength);
    EXPECT_NEAR(height, lobe_height, 0.15 * lobe_height);
    EXPECT_NEAR(place, lobe_wavelength, 0.01 * lobe_wavelength);
}

struct RmsDifference {
    double s, p;
};

/// Between the two models over a window four bands wide around the Bragg wavelength, the mean index of both the root of the mean
/// permittivity.
RmsDifference rms_difference(double n_medium, double layers, double cosine) {
    ReflectanceSetup two_beam;
    two_beam.crystal.n_medium = n_medium;
    two_beam.crystal.index_mean = IndexMean::permittivity;
    two_beam.layers = layers;
    ReflectanceSetup exact = two_beam;
    exact.model = ReflectanceModel::transfer_matrix;
    const double bragg_nm = 2.0 * two_beam.crystal.effective_index(500.0) * cosine / two_beam.planes.g_per_nm(two_beam.crystal);
    const double band_nm = bragg_nm * relative_band_width(two_beam.crystal, two_beam.planes, 500.0, cosine);
    constexpr int points = 201;
    double s = 0.0, p = 0.0;
    for (int i = 0; i < points; ++i) {
        const double wavelength_nm = bragg_nm + band_nm * (4.0 * i / (points - 1) - 2.0);
        const auto a = reflectance_at(two_beam, wavelength_nm, cosine), b = reflectance_at(exact, wavelength_nm, cosine);
        s += (a.s - b.s) * (a.s - b.s);
        p += (a.p - b.p) * (a.p - b.p);
    }
    return {std::sqrt(s / points), std::sqrt(p / points)};
}

TEST(SlabReflectance, TwoBeamAgreesWithTheTransferMatrix) {
    for (const double n_medium : {1.333, 1.40}) {
        CrystalOptics crystal;
        crystal.n_medium = n_medium;
        const double mean_index = std::sqrt(crystal.mean_permittivity(500.0));
        for (const double layers : {10.0, 24.0, 50.0, 100.0, 200.0})
            for (double angle_deg = 0.0; angle_deg <= 60.0; angle_deg += 10.0) {
                const double sine = std::sin(units::rad_from_deg(angle_deg)) / mean_index;
                const RmsDifference rms = rms_difference(n_medium, layers, std::sqrt(1.0 - sine * sine));
                EXPECT_LE(rms.s, 0.015) << n_medium << ", " << layers << " layers, " << angle_deg << " deg";
                EXPECT_LE(rms.p, 0.015) << n_medium << ", " << layers << " layers, " << angle_deg << " deg";
            }
    }
}

/// The comparison can fail: a band 10 % too wide does.
TEST(SlabReflectance, TheComparisonTellsAWrongContrast) {
    ReflectanceSetup setup, wrong;
    setup.layers = wrong.layers = 50.0;
    setup.crystal.index_mean = wrong.crystal.index_mean = IndexMean::permittivity;
    setup.model = ReflectanceModel::transfer_matrix;
    wrong.crystal.n_sphere = 1.4617;  // 1.333 + 1.1 (1.45 - 1.333)
    const double shift = wrong.crystal.effective_index(500.0) / setup.crystal.effective_index(500.0);
    double sum = 0.0;
    for (int i = 0; i <= 100; ++i) {
        const double wavelength_nm = 564.0 + 0.32 * i;
        sum += std::pow(reflectance_at(setup, wavelength_nm, 1.0).s - reflectance_at(wrong, wavelength_nm * shift, 1.0).s, 2);
    }
    EXPECT_GT(std::sqrt(sum / 101.0), 0.015);
}

/// At the angle where p does not couple (planes met at 45 degrees) neither model reflects it.
TEST(SlabReflectance, NoPolarizedCouplingAtFortyFiveDegrees) {
    ReflectanceSetup setup;
    setup.crystal.index_mean = IndexMean::permittivity;
    setup.layers = 100.0;
    const double cosine = std::sqrt(0.5);
    const double bragg_nm = 2.0 * setup.crystal.effective_index(500.0) * cosine / setup.planes.g_per_nm(setup.crystal);
    EXPECT_LT(reflectance_at(setup, bragg_nm, cosine).p, 1e-12);
    EXPECT_GT(reflectance_at(setup, bragg_nm, cosine).s, 0.9);
    setup.model = ReflectanceModel::transfer_matrix;
    EXPECT_LT(reflectance_at(setup, bragg_nm, cosine).p, 1e-3);
    EXPECT_GT(reflectance_at(setup, bragg_nm, cosine).s, 0.9);
}

}  // namespace
}  // namespace opal
