// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "chi_square.h"
#include "formats/opal_asset.h"
#include "formats/units.h"
#include "renderer/core/medium.h"
#include "renderer/core/phase_function.h"
#include "renderer/host/phase_function.h"

namespace opal {
namespace {

/// Draws the cosine of a phase function and checks s = sin(angle / 2), cosine = 1 - 2 s^2, in which peaks are wide.
template <typename Sample, typename Phase>
::testing::AssertionResult check_cosines(const std::string& name, const Sample& sample, const Phase& phase, int cells = 64) {
    return check_sampler(
        name, SamplerDomain<1>{{0.0}, {1.0}, {cells}},
        [&](SamplerRandom& random) { return SamplerPoint<1>{std::sqrt(0.5 * (1.0 - double(sample(random))))}; },
        [&](SamplerPoint<1> s) { return 2.0 * units::pi * 4.0 * s[0] * double(phase(float(1.0 - 2.0 * s[0] * s[0]))); });
}

::testing::AssertionResult check_phase(const std::string& name, const PhaseFunctionView& phase, float wavelength_nm = 550.0f,
                                       int cells = 64) {
    return check_cosines(
        name,
        [&](SamplerRandom& random) {
            const float u1 = random.next();
            return sample_phase_cosine(phase, wavelength_nm, u1, random.next());
        },
        [&](float cosine) { return phase_density(phase, cosine, wavelength_nm); }, cells);
}

/// Integral over the sphere of the phase function and of it times the cosine: trapezoids between cosines that floats hold, even
/// in the angle.
struct Moments {
    double integral = 0.0;
    double mean_cosine = 0.0;
};

Moments moments(const PhaseFunctionView& phase) {
    constexpr int steps = 100'000;
    Moments result;
    float before = 1.0f;
    for (int i = 1; i <= steps; ++i) {
        const float cosine = i == steps ? -1.0f : float(std::cos(units::pi * i / steps));
        const double width = units::pi * (double(before) - double(cosine));
        const double p = double(phase_density(phase, before, 550.0f)), q = double(phase_density(phase, cosine, 550.0f));
        result.integral += width * (p + q);
        result.mean_cosine += width * (p * double(before) + q * double(cosine));
        before = cosine;
    }
    return result;
}

double mean_of_even_draws(const PhaseFunctionView& phase) {
    constexpr int draws = 100'000;
    double sum = 0.0;
    for (int i = 0; i < draws; ++i) sum += double(sample_phase_cosine(phase, 550.0f, (float(i) + 0.5f) / float(draws), 0.5f));
    return sum / draws;
}

/// Normalized, and of the mean cosine that is stated, as far as floats tell cosines apart at the peaks.
void expect_moments(const PhaseFunctionView& phase, double mean_cosine) {
    const Moments found = moments(phase);
    EXPECT_NEAR(found.integral, 1.0, 1.0e-5) << phase.g << " " << phase.alpha;
    EXPECT_NEAR(found.mean_cosine, mean_cosine, 1.0e-5) << phase.g << " " << phase.alpha;
    EXPECT_NEAR(mean_of_even_draws(phase), mean_cosine, 1.0e-5) << phase.g << " " << phase.alpha;
}

TEST(Phase, Rayleigh) {
    EXPECT_TRUE(check_cosines(
        "Rayleigh", [](SamplerRandom& random) { return sample_rayleigh_cosine(random.next()); }, rayleigh_phase));
}

TEST(Phase, HenyeyGreenstein) {
    for (const float g : {-0.99f, -0.6f, 0.0f, 1.0e-4f, 0.3f, 0.8f, 0.95f, 0.99f}) {
        const PhaseFunctionView phase{PhaseKind::henyey_greenstein, g, 0.0f, {}};
        EXPECT_TRUE(check_phase(fmt::format("Henyey-Greenstein {}", g), phase, 550.0f, 128));
        expect_moments(phase, double(g));
    }
}

TEST(Phase, Draine) {
    const float parameters[][2] = {{-0.7f, 1.0f}, {0.0f, 0.0f},  {0.0f, 1.0f},   {0.2f, 1000.0f},
                                   {0.8f, 1.0f},  {0.8f, 50.0f}, {0.97f, 50.0f}, {0.97f, 1000.0f}};
    for (const auto& [g, alpha] : parameters) {
        const PhaseFunctionView phase{PhaseKind::draine, g, alpha, {}};
        EXPECT_TRUE(check_phase(fmt::format("Draine {} {}", g, alpha), phase, 550.0f, 128));
        expect_moments(phase, draine_mean_cosine(double(g), double(alpha)));
    }
    for (const float cosine : {-1.0f, -0.2f, 0.7f}) {
        EXPECT_FLOAT_EQ(draine_phase(cosine, 0.6f, 0.0f), henyey_greenstein_phase(cosine, 0.6f));
        EXPECT_FLOAT_EQ(draine_phase(cosine, 0.0f, 1.0f), rayleigh_phase(cosine));
    }
}

TEST(Phase, Schlick) {
    for (const float k : {-0.8f, 0.0f, 0.005f, 0.5f, 0.98f}) {
        const PhaseFunctionView phase{PhaseKind::schlick, k, 0.0f, {}};
        EXPECT_TRUE(check_phase(fmt::format("Schlick {}", k), phase, 550.0f, 128));
        expect_moments(phase, schlick_mean_cosine(double(k)));
    }
}

TEST(Phase, SamplersAreMonotoneAndStayInRange) {
    std::vector<PhaseFunctionView> phases;
    for (const float g : {-0.9999f, -0.5f, 0.0f, 0.5f, 0.9999f}) {
        phases.push_back({PhaseKind::henyey_greenstein, g, 0.0f, {}});
        phases.push_back({PhaseKind::draine, g, 20.0f, {}});
        phases.push_back({PhaseKind::schlick, g, 0.0f, {}});
    }
    for (const PhaseFunctionView& phase : phases) {
        float before = -1.0f;
        for (int i = 0; i <= 1000; ++i) {
            const float cosine = sample_phase_cosine(phase, 550.0f, std::min(float(i) * 1.0e-3f, 0x1.fffffep-1f), 0.5f);
            EXPECT_LE(cosine, 1.0f);
            EXPECT_GE(cosine, before - 1.0e-6f) << int(phase.kind) << " " << phase.g << " " << i;
            before = cosine;
        }
        // The last draw: at the end of the peak, where there is one.
        if (phase.g < 0.0f) continue;
        EXPECT_NEAR(before, 1.0f, 1.0e-5f) << int(phase.kind) << " " << phase.g;
    }
}

TEST(Phase, ClosedFormsHaveTheAskedMeanCosine) {
    OpalConstants constants;
    for (const double asymmetry : {-0.99, -0.3, 0.0, 0.85, 0.99})
        for (const MiePhase kind : {MiePhase::henyey_greenstein, MiePhase::draine, MiePhase::schlick}) {
            constants.mie_asymmetry = asymmetry;
            constants.mie_phase = kind;
            constants.draine_alpha = 30.0;
            const PhaseFunction phase = make_phase_function(constants);
            EXPECT_NEAR(moments(phase.view()).mean_cosine, asymmetry, 2.0e-5) << int(kind);
            EXPECT_FALSE(phase_varies(phase.view()));
        }
}

TEST(Phase, DeflectKeepsTheCosine) {
    const Vec3 direction = normalize({0.3f, -0.5f, 0.8f});
    for (const float cosine : {-1.0f, -0.4f, 0.0f, 0.9f, 1.0f})
        for (const float u : {0.0f, 0.37f, 0.8f}) EXPECT_NEAR(dot(direction, deflect(direction, cosine, u)), cosine, 2e-6f);
}

CrystalDefect defect_of(double diameter_nm, MieParticle particle) {
    CrystalDefect defect;
    defect.n_sphere = RefractiveIndex::of_material("silica");
    defect.n_medium = RefractiveIndex::of_material("water");
    defect.diameter_nm = diameter_nm;
    defect.particle = particle;
    return defect;
}

TEST(MiePhaseTable, DrawnCosinesFollowTheDensity) {
    for (const double diameter_nm : {100.0, 250.0, 2000.0}) {
        const PhaseTable table =
            make_mie_phase_table(defect_of(diameter_nm, diameter_nm == 250.0 ? MieParticle::vacancy : MieParticle::sphere));
        const PhaseFunctionView phase{PhaseKind::table, 0.0f, 0.0f, table.view()};
        for (const float wavelength_nm : {360.0f, 501.7f, 829.0f})
            EXPECT_TRUE(check_phase(fmt::format("Mie {} nm at {} nm", diameter_nm, wavelength_nm), phase, wavelength_nm, 256));
    }
}

/// One wavelength of a defect and its table: how far they are from each other.
struct TableErrors {
    double largest_deviation = 0.0;  ///< over the series, or over 1 % of an isotropic density where the series is below that
    double mean_cosine = 0.0;
    double misplaced = 0.0;  ///< part of the light that the table sends elsewhere
};

TableErrors table_errors(const CrystalDefect& defect, const PhaseTable& table, double wavelength_nm) {
    const MieCoefficients coefficients =
        mie_coefficients(defect.size_parameter(wavelength_nm), defect.relative_index(wavelength_nm));
    const MieEfficiencies efficiencies = mie_efficiencies(coefficients);
    constexpr std::uint64_t points = 4000;
    TableErrors errors;
    for (std::uint64_t i = 0; i < points; ++i) {
        const double angle_rad = units::pi * (double(i) + double(SamplerRandom(i).next())) / double(points);
        const float cosine = float(std::cos(angle_rad));
        const double series = mie_phase_function(coefficients, efficiencies.q_sca, double(cosine));
        const double difference = std::abs(double(phase_table_density(table.view(), cosine, float(wavelength_nm))) - series);
        errors.largest_deviation = std::max(errors.largest_deviation, difference / std::max(series, 0.01 / (4.0 * units::pi)));
        // Half of the integral of the difference over the sphere.
        errors.misplaced += units::pi * std::sin(angle_rad) * difference * units::pi / double(points);
    }
    errors.mean_cosine = std::abs(table.mean_cosine(wavelength_nm) - efficiencies.asymmetry);
    return errors;
}

/// The table holds what it was made from: to the stated accuracy between its nodes, with the series' mean cosine, at the
/// tabulated wavelengths; halfway between two of them it sends little of the light elsewhere. Records the figures for
/// docs/validation/plot_phase.py.
TEST(MiePhaseTable, HoldsTheSeries) {
    for (const double diameter_nm : {20.0, 50.0, 250.0, 1000.0, 10000.0})
        for (const MieParticle particle : {MieParticle::vacancy, MieParticle::sphere}) {
            const CrystalDefect defect = defect_of(diameter_nm, particle);
            const PhaseTable table = make_mie_phase_table(defect);
            TableErrors largest;
            for (const double wavelength_nm : {360.0, 485.0, 830.0}) {
                const TableErrors at = table_errors(defect, table, wavelength_nm);
                largest.largest_deviation = std::max(largest.largest_deviation, at.largest_deviation);
                largest.mean_cosine = std::max(largest.mean_cosine, at.mean_cosine);
            }
            for (const double wavelength_nm : {362.5, 602.5})
                largest.misplaced = std::max(largest.misplaced, table_errors(defect, table, wavelength_nm).misplaced);
            EXPECT_LT(largest.largest_deviation, phase_table_accuracy) << diameter_nm;
            EXPECT_LT(largest.mean_cosine, 1.0e-4) << diameter_nm;
            // Ripples of large spheres change within some nanometres; the mixture smooths them.
            EXPECT_LT(largest.misplaced, diameter_nm > 1000.0 ? 1.0e-2 : 1.0e-3) << diameter_nm;
            RecordProperty(fmt::format("table_{:05.0f}_{}", diameter_nm, particle == MieParticle::vacancy ? "vacancy" : "sphere"),
                           fmt::format("{} {:.1e} {:.1e} {:.1e}", table.cosine.size(), largest.largest_deviation,
                                       largest.mean_cosine, largest.misplaced));
        }
}

TEST(MiePhaseTable, EveryRowIsNormalized) {
    for (const double diameter_nm : {20.0, 250.0, 5000.0}) {
        const PhaseTable table = make_mie_phase_table(defect_of(diameter_nm, MieParticle::sphere));
        const std::size_t nodes = table.cosine.size();
        for (int w = 0; w < table.num_wavelengths; ++w) {
            const float* row = table.density.data() + std::size_t(w) * nodes;
            double integral = 0.0;
            for (std::size_t i = 0; i + 1 < nodes; ++i)
                integral +=
                    units::pi * (double(table.cosine[i + 1]) - double(table.cosine[i])) * (double(row[i]) + double(row[i + 1]));
            EXPECT_NEAR(integral, 1.0, 1.0e-6) << diameter_nm << " " << w;
        }
    }
}

TEST(MiePhaseTable, SmallDefectsScatterAsRayleighSays) {
    const PhaseTable table = make_mie_phase_table(defect_of(2.0, MieParticle::vacancy));
    for (const float cosine : {-1.0f, -0.33f, 0.1f, 0.95f})
        EXPECT_NEAR(phase_table_density(table.view(), cosine, 700.0f), rayleigh_phase(cosine), 1.0e-3f * rayleigh_phase(cosine));
}

TEST(MiePhaseTable, WithoutContrastItIsTheLimit) {
    CrystalDefect none, hardly;
    none.n_medium = 1.45;
    hardly.n_medium = 1.4501;
    const PhaseTable limit = make_mie_phase_table(none), near = make_mie_phase_table(hardly);
    for (const float cosine : {-1.0f, -0.33f, 0.1f, 0.95f, 1.0f}) {
        const float expected = phase_table_density(near.view(), cosine, 500.0f);
        EXPECT_NEAR(phase_table_density(limit.view(), cosine, 500.0f), expected,
                    2.0 * phase_table_accuracy * std::max(double(expected), 0.01 / (4.0 * units::pi)));
    }
}

TEST(MiePhaseTable, ConstantsNameTheParticle) {
    OpalConstants constants;
    constants.mie_phase = MiePhase::lorenz_mie;
    constants.mie_particle = MieParticle::sphere;
    const PhaseFunction phase = make_phase_function(constants);
    EXPECT_TRUE(phase_varies(phase.view()));
    CrystalDefect defect = crystal_defect(constants);
    EXPECT_EQ(defect.diameter_nm, 250.0);
    const double x = defect.size_parameter(500.0);
    EXPECT_NEAR(x, units::pi * 250.0 * 1.41964 / 500.0, 1.0e-4);
    EXPECT_NEAR(defect.relative_index(500.0), 1.45 / 1.41964, 1.0e-5);
    EXPECT_NEAR(phase.table.mean_cosine(500.0), mie_efficiencies(mie_coefficients(x, defect.relative_index(500.0))).asymmetry,
                1.0e-4);
    constants.mie_particle_diameter_nm = 60.0;
    EXPECT_EQ(crystal_defect(constants).diameter_nm, 60.0);
}

/// The hero draws from its own phase function; weighted by their ratios, its directions have each companion's mean cosine.
TEST(MiePhaseTable, CompanionsSeeTheirOwn) {
    const PhaseTable table = make_mie_phase_table(defect_of(250.0, MieParticle::vacancy));
    MediumView view;
    view.mie_phase = {PhaseKind::table, 0.0f, 0.0f, table.view()};
    const PathWavelengths<4> wavelengths{{500.0f, 617.5f, 740.0f, 390.0f}, {}, 4};
    LaneMedium<4> medium;
    medium.sigma_mie = Lanes<4>::all(1.0f);
    const Vec3 direction = normalize({0.2f, 0.3f, -0.9f});
    constexpr int draws = 300'000;
    double sum[4] = {}, square_sum[4] = {}, ratio_sum[4] = {};
    for (int i = 0; i < draws; ++i) {
        PathRandom random(1, 7, std::uint32_t(i));
        LaneWeights<4> weights;
        const double cosine = double(dot(direction, scatter_direction(view, wavelengths, medium, direction, weights, random)));
        for (int lane = 0; lane < 4; ++lane) {
            const double value = double(weights.ratio.v[lane]) * cosine;
            sum[lane] += value;
            square_sum[lane] += value * value;
            ratio_sum[lane] += double(weights.ratio.v[lane]);
        }
    }
    for (int lane = 0; lane < 4; ++lane) {
        const double mean = sum[lane] / draws;
        const double standard_error = std::sqrt((square_sum[lane] / draws - mean * mean) / draws);
        EXPECT_NEAR(mean, table.mean_cosine(double(wavelengths.wavelength_nm[lane])), 4.0 * standard_error) << lane;
        EXPECT_LT(standard_error, 4.0e-3) << lane;
        EXPECT_NEAR(ratio_sum[lane] / draws, 1.0, 0.02) << lane;
    }
    // Their mean cosines differ by far more than that.
    EXPECT_GT(table.mean_cosine(390.0) - table.mean_cosine(740.0), 0.2);
}

}  // namespace
}  // namespace opal
