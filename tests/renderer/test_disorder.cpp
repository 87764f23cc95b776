// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "chi_square.h"
#include "formats/units.h"
#include "renderer/core/grain_visit.h"
#include "renderer/core/mosaic.h"
#include "renderer/host/stacking.h"

namespace opal {
namespace {

constexpr double pi = units::pi;

/// The normal of a plane tilted by the sampler, as (1 - cos theta) kappa / 2, spread over [0, 12), and azimuth: whatever the
/// normal, the density depends on the angle alone.
TEST(Mosaic, NormalsFollowTheirDensity) {
    for (const double spread_deg : {0.5, 3.0, 25.0})
        for (const Vec3 normal : {Vec3{0.0f, 0.0f, 1.0f}, normalize({0.3f, -0.8f, 0.2f})}) {
            const float kappa = mosaic_exponent(float(units::rad_from_deg(spread_deg)));
            const Frame frame(normal);
            const double largest = std::min(12.0, double(kappa));
            EXPECT_TRUE(check_sampler(
                "mosaic tilt", SamplerDomain<2>{{0.0, -pi}, {largest * 1.000001, pi}, {24, 12}},
                [&](SamplerRandom& random) {
                    while (true) {
                        const float u1 = random.next(), u2 = random.next(), u3 = random.next(), u4 = random.next();
                        const Vec3 tilted = sample_mosaic_tilt(kappa, u1, u2, u3, u4).rotate(normal);
                        const Vec3 off = tilted - normal;
                        const double x = 0.25 * double(kappa) * double(dot(off, off));
                        if (x < largest)
                            return SamplerPoint<2>{
                                x, std::atan2(double(dot(off, frame.bitangent)), double(dot(off, frame.tangent)))};
                    }
                },
                [&](SamplerPoint<2> p) {
                    // Per solid angle, times d(solid angle) = d(azimuth) d(1 - cos); what lies beyond `largest` is drawn again.
                    const double cosine = 1.0 - 2.0 * p[0] / double(kappa);
                    const double inside = 1.0 - std::pow(std::max(0.0, 1.0 - largest / double(kappa)), double(kappa) + 1.0);
                    return double(mosaic_normal_density(kappa, float(cosine))) * 2.0 / double(kappa) / inside;
                }))
                << spread_deg << " deg";
        }
}

TEST(Mosaic, TiltsAreRotationsOfTheStatedSpread) {
    const double spread_rad = units::rad_from_deg(2.0);
    const float kappa = mosaic_exponent(float(spread_rad));
    double square[3] = {};
    constexpr int draws = 200000;
    for (int i = 0; i < draws; ++i) {
        const RandomBlock block = random_block(3, RandomStream::bench, std::uint64_t(i), 0);
        const Quaternion q = sample_mosaic_tilt(kappa, uniform_float(block.value[0]), uniform_float(block.value[1]),
                                                uniform_float(block.value[2]), uniform_float(block.value[3]));
        ASSERT_NEAR(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1.0f, 1e-5f);
        const float component[3] = {2.0f * q.x, 2.0f * q.y, 2.0f * q.z};
        for (int axis = 0; axis < 3; ++axis) square[axis] += double(component[axis]) * double(component[axis]) / draws;
    }
    // Small angles: twice the vector part is the rotation vector; its variance has a relative standard error of sqrt(2 / draws).
    for (const double variance : square)
        EXPECT_NEAR(variance / (spread_rad * spread_rad), 1.0, 4.0 * std::sqrt(2.0 / draws) + 2.0 / double(kappa));
}

/// The lobe that light sampling can connect to: mirrored directions, binned over the sphere around the middle one.
TEST(Mosaic, TurnedDirectionsFollowTheirDensity) {
    const float kappa = mosaic_exponent(float(units::rad_from_deg(4.0)));
    const Vec3 normal{0.0f, 0.0f, 1.0f}, direction = normalize({0.5f, 0.1f, -0.7f});
    const Frame lobe(normalize(mirror(direction, normal)));
    const double reach = 0.35;
    const auto local = [&](Vec3 v) { return SamplerPoint<2>{double(dot(v, lobe.tangent)), double(dot(v, lobe.bitangent))}; };
    const auto inside = [&](SamplerPoint<2> p) { return std::abs(p[0]) < reach && std::abs(p[1]) < reach; };
    const auto density = [&](SamplerPoint<2> p) {
        const double height = std::sqrt(1.0 - p[0] * p[0] - p[1] * p[1]);
        const Vec3 turned = lobe.world_from_local({float(p[0]), float(p[1]), float(height)});
        return double(mosaic_direction_density(kappa, normal, direction, normalize(turned))) / height;
    };
    const double covered = chi_square_detail::integrate<2>(density, {-reach, -reach}, {reach, reach}, 1e-6, 8);
    EXPECT_GT(covered, 0.95);
    EXPECT_LT(covered, 1.0);
    EXPECT_TRUE(check_sampler(
        "mosaic lobe", SamplerDomain<2>{{-reach, -reach}, {reach, reach}, {24, 24}},
        [&](SamplerRandom& random) {
            while (true) {
                const float u1 = random.next(), u2 = random.next(), u3 = random.next(), u4 = random.next();
                const Vec3 tilted = sample_mosaic_tilt(kappa, u1, u2, u3, u4).rotate(normal);
                const Vec3 turned = normalize(mirror(direction, tilted));
                if (dot(turned, lobe.normal) > 0.0f && inside(local(turned))) return local(turned);
            }
        },
        [&](SamplerPoint<2> p) { return density(p) / covered; }));
}

/// Mean interference of long stacks of layers, drawn one by one: intensity per layer at a phase per layer.
double stack_intensity(double fault, double turns, int layers, int stacks) {
    double sum = 0.0;
    for (int stack = 0; stack < stacks; ++stack) {
        std::complex<double> amplitude = 0.0;
        int position = 0, step = stack % 2 == 0 ? 1 : 2;
        RandomBlock block{};
        for (int layer = 0; layer < layers; ++layer) {
            if (layer % 4 == 0) block = random_block(9, RandomStream::bench, std::uint64_t(stack), std::uint32_t(layer / 4));
            amplitude += std::polar(1.0, 2.0 * pi * (position / 3.0 - turns * layer));
            if (double(uniform_float(block.value[layer % 4])) < fault) step = 3 - step;
            position = (position + step) % 3;
        }
        sum += std::norm(amplitude) / layers;
    }
    return sum / stacks;
}

/// Peaks of the rods against stacks of 600 layers: where they are, how high and how much of the rod's intensity lies in each
/// half.
TEST(Stacking, PeaksAreAsHighAsTheirRods) {
    for (const double fault : {0.02, 0.1, 0.3, 0.8, 0.97}) {
        const std::vector<StackingPeak> peaks = stacking_peaks(fault);
        double weight = 0.0;
        for (const StackingPeak& peak : peaks) weight += peak.weight;
        EXPECT_NEAR(weight, 1.0, 1e-12);
        const StackingPeak& strongest = peaks[0].weight > peaks[1].weight ? peaks[0] : peaks[1];
        double sum = 0.0;
        for (const StackingPeak& peak : peaks) {
            const double r = peak.correlation;
            sum += peak.weight * (1.0 - r * r) / (1.0 + r * r - 2.0 * r * std::cos(2.0 * pi * (strongest.turns - peak.turns)));
        }
        EXPECT_NEAR(sum / rod_intensity(fault, strongest.turns), 1.0, 1e-9) << fault;
    }
}

/// The rod's intensity against drawn stacks, each an exponential variate around it: 4 standard errors of their mean, and what
/// stacks of a finite number of layers lack, (height)/(layers).
TEST(Stacking, RodsAreThoseOfDrawnStacks) {
    for (const double fault : {0.02, 0.1, 0.3, 0.47, 0.8, 0.97})
        for (const double turns : {0.0, 0.2, 0.33, 0.36, 0.5}) {
            constexpr int layers = 1000, stacks = 1000;
            const double expected = rod_intensity(fault, turns);
            EXPECT_NEAR(stack_intensity(fault, turns, layers, stacks) / expected, 1.0,
                        4.0 / std::sqrt(double(stacks)) + 60.0 / layers)
                << fault << " " << turns;
        }
}

/// No jump where the twins' peaks meet, nor where hcp's second peak begins.
TEST(Stacking, PeaksChangeWithoutAJump) {
    for (const double fault : {2.0 * std::sqrt(3.0) - 3.0, 0.5}) {
        const auto layers = [](const std::vector<StackingPeak>& peaks) {
            double sum = 0.0;
            for (const StackingPeak& peak : peaks)
                if (std::abs(peak.turns - 0.5) < 0.01) sum += peak.weight * (1.0 + peak.correlation) / (1.0 - peak.correlation);
            return sum;
        };
        EXPECT_NEAR(layers(stacking_peaks(fault - 1e-6)), layers(stacking_peaks(fault + 1e-6)), 0.01) << fault;
    }
}

TEST(Stacking, FewFaultsGiveBothTwinsOfFcc) {
    const CrystalParameters crystal{300.0, 1.45, 1.333};
    std::vector<PlanePair> fcc = stacked_pairs(crystal, 0.0, 360.0);
    const std::vector<PlanePair> twins = stacked_pairs(crystal, 1e-9, 360.0);
    double sharp = 0.0, blurred = 0.0;
    for (const PlanePair& pair : twins) (pair.twin == 0 ? sharp : blurred) += 1.0;
    // Planes off the stacking axis' rods come once for each twin; those of the lattice's own are fcc's.
    EXPECT_EQ(sharp + 0.5 * blurred, double(fcc.size()));
    for (const PlanePair& pair : fcc) {
        const auto same = [&](const PlanePair& twin) {
            return twin.twin >= 0 && std::abs(dot(twin.normal, pair.normal)) > 1.0f - 1e-5f &&
                   std::abs(twin.g_per_nm / pair.g_per_nm - 1.0f) < 1e-4f && std::abs(twin.form / pair.form - 1.0f) < 1e-3f;
        };
        EXPECT_TRUE(std::any_of(twins.begin(), twins.end(), same)) << pair.h << pair.k << pair.l;
    }
}

/// Layers counted one by one: the share of a grain's layers that are in the sense of its first.
TEST(Stacking, FewFaultsLeaveAGrainItsOwnSense) {
    EXPECT_EQ(own_twin_excess(0.0f, 1000.0f), 1.0f);
    for (const double fault : {1e-4, 1e-3, 0.02}) {
        constexpr int layers = 2000, grains = 2000;
        double excess = 0.0;
        for (int grain = 0; grain < grains; ++grain) {
            int sense = 1;
            RandomBlock block{};
            for (int layer = 0; layer < layers; ++layer) {
                if (layer % 2 == 0) block = random_block(10, RandomStream::bench, std::uint64_t(grain), std::uint32_t(layer / 2));
                excess += sense;
                if (uniform_double(block.value[2 * (layer % 2)], block.value[2 * (layer % 2) + 1]) < fault) sense = -sense;
            }
        }
        EXPECT_NEAR(excess / layers / grains, double(own_twin_excess(float(fault), float(layers))),
                    4.0 / std::sqrt(double(grains)))
            << fault;
    }
}

/// hcp of touching spheres: the structure factors of its two atoms, |1 + exp(2 pi i (H/3 + 2K/3 + L/2))|^2 / 4: 1, 3/4, 1/4 or 0.
TEST(Stacking, OnlyFaultsGiveHcp) {
    const CrystalParameters crystal{300.0, 1.45, 1.333};
    const double layers_nm = std::sqrt(2.0 / 3.0) * 300.0;
    for (const PlanePair& pair : stacked_pairs(crystal, 1.0, 360.0)) {
        const double form = std::abs(sphere_form_factor(300.0, double(pair.g_per_nm)));
        const float along_axis = dot(pair.normal, Vec3{1, 1, 1}) / std::sqrt(3.0f) * pair.g_per_nm;
        const int half_orders = int(std::lround(2.0 * double(along_axis) * layers_nm));
        EXPECT_NEAR(2.0 * double(along_axis) * layers_nm, half_orders, 1e-3);
        const bool in_phase = (pair.h + pair.k) % 3 == 0;
        const double structure = in_phase ? (half_orders % 2 == 0 ? 1.0 : 0.0) : (half_orders % 2 == 0 ? 0.25 : 0.75);
        EXPECT_NEAR(double(pair.form), form * std::sqrt(structure), 1e-3 * form) << pair.h << pair.k << pair.l;
        EXPECT_GT(pair.coherence_nm, 1.0e30f);
    }
}

}  // namespace
}  // namespace opal
