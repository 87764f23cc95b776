// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "chi_square.h"
#include "on_backends.h"
#include "renderer/host/spectrum_tables.h"
#include "small_opal.h"

namespace opal {
namespace {

/// Those that end with Loop are short enough to run in the devices' loop, too.
class Media : public OnBackends {};
class MediaLoop : public OnBackends {};

/// A plate seen from above in uniform light.
Rendered render_plate(const char* backend, const SmallOpal& small, const std::string& settings, int samples) {
    const ScratchFolder folder;
    write_opal_asset(small.make(), folder / "plate.vdb");
    return render_text(
        "[render]\nwidth = 24\nheight = 24\nsampler = \"independent\"\n[camera]\nkind = \"orthographic\"\n"
        "position_mm = [0, 0, 30]\ntarget_mm = [0, 0, 0]\nup = [0, 1, 0]\nview_height_mm = 1.0\n[environment]\nkind = "
        "\"constant\"\n[[object]]\nkind = \"opal\"\nfile = '" +
            (folder / "plate.vdb").string() + "'\n[opal]\n" + settings,
        samples, backend);
}

SmallOpal plate() {
    SmallOpal small;
    small.radius_mm = 2.0;
    small.half_thickness_mm = 0.5;
    small.grains = 1;
    small.field_voxel_mm = 0.1;
    small.constants.n_sphere = 1.5;
    small.constants.n_medium = 1.5;
    return small;
}

/// An absorber twenty times stronger at one end of the spectrum than at the other.
SampledSpectrum steep_absorber() {
    SampledSpectrum spectrum;
    for (double wavelength_nm = 360.0; wavelength_nm <= 830.0; wavelength_nm += 5.0) {
        spectrum.wavelength_nm.push_back(wavelength_nm);
        spectrum.value.push_back(0.2 * std::pow(20.0, (wavelength_nm - 360.0) / 470.0));
    }
    return spectrum;
}

/// Reflected and transmitted light of a plate in uniform light, as in the test of the homogeneous slab: absorption enters by its
/// optical depth alone, in whichever way it is spread over the thickness.
double plate_radiance(double n, double optical_depth) {
    const double f = std::pow((n - 1.0) / (n + 1.0), 2), a = std::exp(-optical_depth);
    const double transmitted = (1.0 - f) * (1.0 - f) * a / (1.0 - f * f * a * a);
    return f + f * a * transmitted + transmitted;
}

/// All 48 bins within 4 standard errors of Beer's and Lambert's law. `mean_scale`: of the field over the thickness.
void expect_beer_lambert(const char* backend, const SmallOpal& small, double mean_scale, const std::string& settings) {
    const Rendered rendered = render_plate(backend, small, settings, 1536);
    EXPECT_EQ(rendered.outcome.counters.majorant_violations, 0u);
    const SpectrumTablesData tables = make_spectrum_tables();
    for (int bin = 0; bin < num_bins; ++bin) {
        double expected = 0.0, white = 0.0;
        int count = 0;
        for (double w = std::max(360.0, bin_centre_nm(bin) - 5.0) + 0.05; w < std::min(830.0, bin_centre_nm(bin) + 5.0);
             w += 0.1, ++count) {
            const double light = double(table_at(tables.view().white, float(w)));
            white += light;
            expected += light * plate_radiance(1.5, mean_scale * small.constants.sigma_a_per_mm.at(w));
        }
        const SpectrumTotals& totals = rendered.outcome.totals;
        const double n = double(totals.samples);
        const double mean = totals.radiance[std::size_t(bin)] / n;
        const double error = std::sqrt((totals.radiance_squared[std::size_t(bin)] / n - mean * mean) / n);
        EXPECT_NEAR(mean * count / white, expected / white, 4.0 * error * count / white)
            << settings << ", " << bin_centre_nm(bin) << " nm";
        EXPECT_LT(error / mean, 0.06);
    }
}

TEST_P(Media, AbsorptionInLayersFollowsBeerLambertAtEveryWavelength) {
    SmallOpal small = plate();
    small.constants.sigma_a_per_mm = steep_absorber();
    // Voxels lie at multiples of 0.1 mm, so the integral over [-0.5, 0.5] is the trapezoid of their values: 5 of 10 steps.
    small.fields[0] = [](const auto& p) { return std::lround(p.z() / 0.1) % 2 == 0 ? 2.0 : 0.0; };
    expect_beer_lambert(GetParam(), small, 1.0, "majorants = \"global\"\ncompanions = 0\n");
    expect_beer_lambert(GetParam(), small, 1.0, "majorants = \"local\"\ncompanions = 3\n");
    expect_beer_lambert(GetParam(), small, 1.0, "majorants = \"global\"\ncompanions = 7\n");
}

TEST_P(Media, AbsorptionAlongAGradientFollowsBeerLambertAtEveryWavelength) {
    SmallOpal small = plate();
    small.constants.sigma_a_per_mm = steep_absorber();
    small.fields[0] = [](const auto& p) { return std::max(0.0, 0.8 + 1.5 * p.z()); };
    for (const char* companions : {"0", "3", "7"})
        expect_beer_lambert(GetParam(), small, 0.8, "companions = " + std::string(companions) + "\n");
}

double difference_statistic(const SpectrumTotals& a, const SpectrumTotals& b) {
    double statistic = 0.0;
    for (std::size_t bin = 0; bin < num_bins; ++bin) {
        const auto mean = [&](const SpectrumTotals& totals) { return totals.radiance[bin] / double(totals.samples); };
        const auto variance = [&](const SpectrumTotals& totals) {
            return (totals.radiance_squared[bin] / double(totals.samples) - mean(totals) * mean(totals)) / double(totals.samples);
        };
        const double error = std::sqrt(variance(a) + variance(b)), difference = mean(a) - mean(b);
        EXPECT_NEAR(difference, 0.0, 4.0 * error) << bin_centre_nm(int(bin)) << " nm";
        statistic += difference * difference / (error * error);
    }
    return statistic;
}

/// The field is the same wherever the picture looks, but not at a corner of the plate, so that it stays a field: with one cell
/// for all of it every collision is tentative.
TEST_P(Media, GridsEqualHomogeneousMediaOfTheSameValue) {
    SmallOpal uniform = plate();
    uniform.constants.sigma_a_per_mm = absorber_spectrum("light-blue-dye", 0.05);
    uniform.constants.sigma_s_rayleigh_400nm_per_mm = 0.6;
    uniform.constants.sigma_s_mie_per_mm = 0.3;
    SmallOpal grids = uniform;
    const auto except_at_a_corner = [](double value) {
        return
            [value](const openvdb::Vec3d& p) { return p.x() > 1.85 && p.y() > 1.85 ? (p.z() > 0.0 ? 0.0 : 2.0 * value) : value; };
    };
    grids.fields = {except_at_a_corner(1.0), except_at_a_corner(0.6), except_at_a_corner(0.3)};
    for (const char* companions : {"companions = 0\n", "companions = 3\n"}) {
        const SpectrumTotals homogeneous = render_plate(GetParam(), uniform, companions, 512).outcome.totals;
        for (const char* majorants : {"majorants = \"local\"\n", "majorants = \"global\"\n", "tracking = \"ratio\"\n"}) {
            const Rendered rendered = render_plate(GetParam(), grids, std::string(companions) + majorants, 512);
            EXPECT_EQ(rendered.outcome.counters.majorant_violations, 0u);
            const double statistic = difference_statistic(rendered.outcome.totals, homogeneous);
            EXPECT_LT(statistic, chi_square_limit(num_bins)) << companions << majorants;
        }
    }
}

TEST_P(MediaLoop, ConstantGridsGiveTheSameBitsAsNone) {
    SmallOpal without = plate();
    without.constants.sigma_a_per_mm = absorber_spectrum("carbon", 0.4);
    without.constants.sigma_s_rayleigh_400nm_per_mm = 0.5;
    SmallOpal with = without;
    with.fields[0] = [](const auto&) { return 1.0; };
    with.fields[1] = [](const auto&) { return 0.5; };
    with.fields[2] = [](const auto&) { return 0.0; };
    EXPECT_EQ(render_plate(GetParam(), with, "", 8).image.pixels, render_plate(GetParam(), without, "", 8).image.pixels);
}

INSTANTIATE_TEST_SUITE_P(, Media, cpu_and_cuda(), backend_name);
INSTANTIATE_TEST_SUITE_P(, MediaLoop, cpu_loop_and_cuda(), backend_name);

}  // namespace
}  // namespace opal
