// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "chi_square.h"
#include "renderer/core/medium_flight.h"
#include "renderer/host/medium_fields.h"
#include "small_opal.h"

namespace opal {
namespace {

/// A ball with fields, as flights see it.
struct FieldBall {
    OpalAsset asset;
    std::unique_ptr<MediumFields> fields;
    OpalView opal;

    explicit FieldBall(const SmallOpal& small, MajorantKind kind = MajorantKind::local) : asset(small.make()) {
        fields = std::make_unique<MediumFields>(asset, kind, 1.0, "test.vdb");
        fields->attach(opal.medium);
    }
};

SmallOpal varied() {
    SmallOpal small;
    small.grains = 1;
    small.constants.sigma_a_per_mm = absorber_spectrum("neutral", 0.5);
    small.fields[0] = [](const auto& p) { return 1.0 + 0.9 * std::sin(2.0 * p.z()) * std::cos(p.x()); };
    small.fields[1] = [](const auto& p) { return 0.3 * std::exp(0.5 * p.z()); };
    small.fields[2] = [](const auto& p) { return p.z() > 0.4 ? 0.6 : 0.05; };
    return small;
}

LaneMedium<4> unlike_lanes() {
    LaneMedium<4> medium;
    const float sigma_a[] = {0.3f, 0.5f, 0.02f, 0.4f}, rayleigh[] = {0.5f, 0.8f, 0.3f, 0.1f}, mie[] = {0.5f, 0.4f, 0.6f, 0.5f};
    for (int i = 0; i < 4; ++i) {
        medium.sigma_a.v[i] = sigma_a[i];
        medium.sigma_rayleigh.v[i] = rayleigh[i];
        medium.sigma_mie.v[i] = mie[i];
    }
    return medium;
}

const Ray through_the_ball{{0.2f, -0.1f, -2.8f}, {0.0f, 0.28f, 0.96f}};
constexpr float way_mm = 5.5f;

struct Local {
    double sigma_a, sigma_s;
};

Local local_at(const MediumView& view, const LaneMedium<4>& medium, int lane, double distance_mm) {
    const Vec3 place = through_the_ball.origin + float(distance_mm) * through_the_ball.direction;
    const auto value = [&](int f) { return view.fields[f].grid ? double(field_value(view.fields[f], place)) : 1.0; };
    return {value(0) * double(medium.sigma_a.v[lane]),
            value(1) * double(medium.sigma_rayleigh.v[lane]) + value(2) * double(medium.sigma_mie.v[lane])};
}

/// What light does on the way, by the midpoint rule in steps of a hundredth of a voxel.
struct Expected {
    double passed, scattered;
    std::vector<double> scattered_by;  ///< without absorption: the share scattered within each step
};

Expected integrate(const MediumView& view, const LaneMedium<4>& medium, int lane) {
    constexpr int steps = 2200;
    const double step_mm = double(way_mm) / steps;
    Expected expected{0.0, 0.0, {}};
    double absorption = 0.0, scattering = 0.0;
    for (int k = 0; k < steps; ++k) {
        const Local local = local_at(view, medium, lane, (k + 0.5) * step_mm);
        const double before = std::exp(-scattering - absorption - 0.5 * step_mm * (local.sigma_a + local.sigma_s));
        expected.scattered += before * local.sigma_s * step_mm;
        absorption += local.sigma_a * step_mm;
        scattering += local.sigma_s * step_mm;
        expected.scattered_by.push_back(1.0 - std::exp(-scattering));
    }
    expected.passed = std::exp(-absorption - scattering);
    return expected;
}

struct Sum {
    double sum = 0.0, squares = 0.0;
    int count = 0;

    void add(double x) {
        sum += x;
        squares += x * x;
        ++count;
    }
    double mean() const { return sum / count; }
    double error() const { return std::sqrt((squares / count - mean() * mean()) / count); }
};

struct Flown {
    Sum passed[4], scattered[4], probability[4];
    std::vector<float> distances_mm;
    std::uint64_t violations = 0;
};

/// Flies many times, each in pieces of random lengths, as grains cut a flight.
Flown fly(const OpalView& opal, const LaneMedium<4>& medium, int count) {
    Flown flown;
    for (int k = 0; k < count; ++k) {
        PathRandom random(7, 1, std::uint32_t(k)), cuts(8, 2, std::uint32_t(k));
        LaneWeights<4> weights;
        MediumFlight<4> flight(opal, medium, through_the_ball, weights, random, flown.violations);
        float end_mm = 0.0f, reached_mm = 0.0f;
        while (end_mm < way_mm && !flight.scattered()) {
            end_mm = std::min(way_mm, end_mm + 1.5f * cuts.next());
            reached_mm = flight.advance(end_mm, weights);
        }
        if (flight.scattered()) flown.distances_mm.push_back(reached_mm);
        for (int i = 0; i < 4; ++i) {
            const double chosen =
                flight.scattered() ? double(flight.local().sigma_s(i)) / double(flight.local().sigma_s(0)) : 1.0;
            const double ratio = double(weights.ratio.v[i]) * chosen, light = ratio * double(weights.throughput.v[i]);
            flown.passed[i].add(flight.scattered() ? 0.0 : light);
            flown.scattered[i].add(flight.scattered() ? light : 0.0);
            flown.probability[i].add(ratio);
        }
    }
    return flown;
}

void expect_physics(const OpalView& opal, const LaneMedium<4>& medium, int count, const std::string& what) {
    const Flown flown = fly(opal, medium, count);
    EXPECT_EQ(flown.violations, 0u) << what;
    for (int i = 0; i < 4; ++i) {
        const Expected expected = integrate(opal.medium, medium, i);
        EXPECT_NEAR(flown.passed[i].mean(), expected.passed, 4.0 * flown.passed[i].error()) << what << ", lane " << i;
        EXPECT_NEAR(flown.scattered[i].mean(), expected.scattered, 4.0 * flown.scattered[i].error()) << what << ", lane " << i;
        EXPECT_NEAR(flown.probability[i].mean(), 1.0, 4.0 * flown.probability[i].error() + 1e-6) << what << ", lane " << i;
        EXPECT_LT(flown.passed[i].error(), 0.04 * expected.passed) << "too noisy to say anything";
    }
    const Expected hero = integrate(opal.medium, medium, 0);
    const auto share = [&](double distance_mm) {
        const double position = distance_mm / double(way_mm) * double(hero.scattered_by.size());
        return position < 1.0 ? 0.0 : hero.scattered_by[std::min(hero.scattered_by.size(), std::size_t(position)) - 1];
    };
    constexpr int bins = 44;
    std::vector<double> observed(bins, 0.0);
    for (const float distance_mm : flown.distances_mm)
        observed[std::size_t(std::min(bins - 1, int(distance_mm / way_mm * float(bins))))] += 1.0;
    double statistic = 0.0;
    for (int bin = 0; bin < bins; ++bin) {
        const double expected =
            count * (share(double(way_mm) * (bin + 1) / bins * (1.0 + 1e-9)) - share(double(way_mm) * bin / bins * (1.0 + 1e-9)));
        statistic += (observed[std::size_t(bin)] - expected) * (observed[std::size_t(bin)] - expected) / expected;
    }
    EXPECT_LT(statistic, chi_square_limit(bins)) << what << ": distances of the hero's scattering";
}

MajorantGrid changed(const MajorantGrid& grid, float max_factor, float min_factor) {
    std::vector<MajorantCell> cells = grid.cells();
    for (MajorantCell& cell : cells)
        for (int f = 0; f < num_medium_fields; ++f) {
            cell.max[f] *= max_factor;
            cell.min[f] *= min_factor;
        }
    return MajorantGrid(std::move(cells), grid.view());
}

TEST(MediumFlight, EveryLaneIsPhysicalWithLocalAndGlobalMajorants) {
    for (const MajorantKind kind : {MajorantKind::local, MajorantKind::global}) {
        const FieldBall ball(varied(), kind);
        expect_physics(ball.opal, unlike_lanes(), 100000, kind == MajorantKind::local ? "local" : "global");
    }
}

TEST(MediumFlight, LooseMajorantsChangeNothingButTime) {
    FieldBall ball(varied());
    const MajorantGrid tight = *ball.fields->majorants();
    for (const float factor : {1.0f, 10.0f, 100.0f}) {
        const MajorantGrid loose = changed(tight, factor, 0.0f);
        ball.opal.medium.majorants = loose.view();
        expect_physics(ball.opal, unlike_lanes(), factor > 50.0f ? 20000 : 50000, fmt::format("{} times too large", factor));
    }
}

TEST(MediumFlight, FineCellsChangeNothing) {
    FieldBall ball(varied());
    const openvdb::BBoxd bounds(openvdb::Vec3d(-3.2), openvdb::Vec3d(3.2));
    const MajorantGrid fine(
        {fit_field(*ball.asset.sigma_a_scale, *ball.asset.shape),
         fit_field(*ball.asset.sigma_s_rayleigh_400nm, *ball.asset.shape), fit_field(*ball.asset.sigma_s_mie, *ball.asset.shape)},
        bounds, 50);
    ball.opal.medium.majorants = fine.view();
    expect_physics(ball.opal, unlike_lanes(), 50000, "cells smaller than a voxel");
}

/// A majorant that is none must show. (The transport clamps to it, and so would be biased without a word.)
TEST(MediumFlight, ViolationsAreCounted) {
    FieldBall ball(varied());
    const MajorantGrid low = changed(*ball.fields->majorants(), 0.9f, 0.5f);
    ball.opal.medium.majorants = low.view();
    EXPECT_GT(fly(ball.opal, unlike_lanes(), 2000).violations, 100u);
}

TEST(MediumFlight, OpticalDepthsFromAThousandthToTenThousand) {
    for (const double depth : {1e-3, 1.0, 30.0, 1e4}) {
        SmallOpal small = varied();
        small.fields[1] = small.fields[2] = nullptr;
        const FieldBall absorbing(small);
        LaneMedium<4> medium;
        for (float& sigma_a : medium.sigma_a.v) sigma_a = float(depth) / way_mm;
        const Flown absorbed = fly(absorbing.opal, medium, 20000);
        const double passed = integrate(absorbing.opal.medium, medium, 0).passed;
        EXPECT_NEAR(absorbed.passed[0].mean(), passed, 4.0 * absorbed.passed[0].error() + 1e-9) << depth;
        EXPECT_EQ(absorbed.distances_mm.size(), 0u);

        small = varied();
        small.fields[0] = small.fields[1] = nullptr;
        const FieldBall scattering(small);
        LaneMedium<4> white;
        for (float& mie : white.sigma_mie.v) mie = float(depth) / (0.3f * way_mm);
        const Flown turned = fly(scattering.opal, white, 20000);
        const double straight = integrate(scattering.opal.medium, white, 0).passed;
        const double error = std::sqrt(straight * (1.0 - straight) / 20000.0);
        EXPECT_NEAR(turned.passed[0].mean(), straight, 4.0 * error + 1e-9) << depth;
        for (int i = 0; i < 4; ++i) EXPECT_NEAR(turned.probability[i].mean(), 1.0, 1e-5);
    }
}

/// One column of voxels: light along it scatters as its value says, light beside it never.
TEST(MediumFlight, Needle) {
    SmallOpal small;
    small.grains = 1;
    small.field_voxel_mm = 0.1;
    small.fields[2] = [](const auto& p) { return std::hypot(p.x(), p.y()) < 0.05 ? 2.0 : 0.0; };
    const FieldBall ball(small);
    LaneMedium<1> medium;
    medium.sigma_mie.v[0] = 1.0f;
    const auto share_passed = [&](float x) {
        int passed = 0;
        for (std::uint32_t k = 0; k < 20000; ++k) {
            PathRandom random(7, 3, k);
            LaneWeights<1> weights;
            std::uint64_t violations = 0;
            MediumFlight<1> flight(ball.opal, medium, {{x, 0.0f, -0.5f}, {0.0f, 0.0f, 1.0f}}, weights, random, violations);
            flight.advance(1.0f, weights);
            passed += flight.scattered() ? 0 : 1;
            EXPECT_EQ(violations, 0u);
        }
        return passed / 20000.0;
    };
    EXPECT_NEAR(share_passed(0.0f), std::exp(-2.0), 4.0 * std::sqrt(0.135 * 0.865 / 20000.0));
    EXPECT_NEAR(share_passed(0.05f), std::exp(-1.0), 4.0 * std::sqrt(0.368 * 0.632 / 20000.0));
    EXPECT_EQ(share_passed(0.11f), 1.0);
}

}  // namespace
}  // namespace opal
