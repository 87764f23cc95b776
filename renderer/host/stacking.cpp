// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/stacking.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "formats/units.h"

namespace opal {
namespace {

struct Vec3d {
    double x, y, z;
};

Vec3d combine(double a, Vec3d u, double b, Vec3d v, double c, Vec3d w) {
    return {a * u.x + b * v.x + c * w.x, a * u.y + b * v.y + c * w.y, a * u.z + b * v.z + c * w.z};
}

std::vector<PlanePair> fcc_pairs(const CrystalParameters& crystal, double wavelength_min_nm) {
    std::vector<PlanePair> pairs(max_plane_pairs);
    const int inside = reciprocal_pairs(crystal, wavelength_min_nm, pairs.data(), max_plane_pairs);
    pairs.resize(std::size_t(std::min(inside, max_plane_pairs)));
    return pairs;
}

/// Height of a peak of correlation r at `turns` from its middle.
double peak_height(double r, double turns) {
    return (1.0 - r * r) / (1.0 + r * r - 2.0 * r * std::cos(2.0 * units::pi * turns));
}

}  // namespace

double stacked_layer_nm(double sphere_diameter_nm) {
    return std::sqrt(2.0 / 3.0) * sphere_diameter_nm;
}

double rod_intensity(double fault, double turns) {
    // The correlations C_m of layers m apart obey C_(m+1) = trace C_m - determinant C_(m-1), C_0 = 1, C_1 = cos(2 pi/3): their
    // generating function is rational.
    const double trace = -(1.0 - fault), determinant = 1.0 - 2.0 * fault;
    const std::complex<double> z = std::polar(1.0, -2.0 * units::pi * turns);
    return 2.0 * ((1.0 + (-0.5 - trace) * z) / (1.0 - trace * z + determinant * z * z)).real() - 1.0;
}

std::vector<StackingPeak> stacking_peaks(double fault) {
    // Step phase +-2 pi/3, the sense kept with probability 1 - fault: trace and determinant of the chain's matrix.
    const double trace = -(1.0 - fault), determinant = 1.0 - 2.0 * fault;
    const double discriminant = trace * trace - 4.0 * determinant;
    if (discriminant < 0.0) {
        // Twins, alike but for their place: as sharp as makes them, with the tail of the other, as high as the rod is there.
        const double turns = std::acos(0.5 * trace / std::sqrt(determinant)) / (2.0 * units::pi);
        const double height = rod_intensity(fault, turns);
        double low = 0.0, high = 1.0;
        for (int i = 0; i < 60; ++i) {
            const double r = 0.5 * (low + high);
            (0.5 * (peak_height(r, 0.0) + peak_height(r, 2.0 * turns)) < height ? low : high) = r;
        }
        return {{turns, 0.5, low, true}, {1.0 - turns, 0.5, low, true}};
    }
    // The first step's mean is cos(2 pi/3): w1 l1 + w2 l2 = -1/2, w1 + w2 = 1.
    const double larger = 0.5 * (trace + std::sqrt(discriminant)), smaller = 0.5 * (trace - std::sqrt(discriminant));
    const double weight = larger > smaller ? (-0.5 - smaller) / (larger - smaller) : 0.0;
    // Both below zero: one wide peak and a wider one to be taken off it. One peak of their height stands for them.
    const double height = rod_intensity(fault, 0.5);
    if (larger <= 0.0) return {{0.5, 1.0, (height - 1.0) / (height + 1.0), false}};
    return {{0.0, weight, larger, false}, {0.5, 1.0 - weight, -smaller, false}};
}

std::vector<PlanePair> stacked_pairs(const CrystalParameters& crystal, double fault, double wavelength_min_nm) {
    if (fault <= 0.0) return fcc_pairs(crystal, wavelength_min_nm);
    const double d_nm = crystal.sphere_diameter_nm;
    const double layers_nm = stacked_layer_nm(d_nm);
    const double g_max_per_nm = 2.0 * effective_index(crystal) / wavelength_min_nm;
    const double s2 = std::sqrt(0.5), s3 = std::sqrt(1.0 / 3.0), s6 = std::sqrt(1.0 / 6.0);
    // Layers are spanned by d (1,-1,0)/sqrt2 and d (1,0,-1)/sqrt2; `across` and `along` are at right angles in their plane,
    // `axis` is [111].
    const Vec3d across{s2, -s2, 0.0}, along{s6, s6, -2.0 * s6}, axis{s3, s3, s3};
    const double b_per_nm = 2.0 / (std::sqrt(3.0) * d_nm);
    const int limit = int(g_max_per_nm / b_per_nm * 2.0) + 2, layer_limit = int(g_max_per_nm * layers_nm) + 2;
    const std::vector<StackingPeak> blurred = stacking_peaks(fault);
    const std::vector<StackingPeak> sharp = {{0.0, 1.0, 1.0, false}};

    std::vector<PlanePair> pairs;
    for (int h = -limit; h <= limit; ++h)
        for (int k = -limit; k <= limit; ++k)
            for (const StackingPeak& peak : ((h + k) % 3 == 0 ? sharp : blurred))
                for (int layer = -layer_limit; layer <= layer_limit; ++layer) {
                    // b1 and b2 make 120 degrees with each other for a1, a2 at 60: b1 = b (cos 30, -sin 30), b2 = b (0, 1).
                    const double in_across = b_per_nm * h * std::sqrt(0.75), in_along = b_per_nm * (k - 0.5 * h);
                    const double up = (layer + peak.turns) / layers_nm;
                    const double g_per_nm = std::sqrt(in_across * in_across + in_along * in_along + up * up);
                    if (g_per_nm > g_max_per_nm || g_per_nm < 1.0e-9) continue;
                    // One of each pair +-G: -G of a peak at `turns` is the peak at 1 - turns on the opposite rod.
                    const bool first = up > 1.0e-12 || (std::abs(up) <= 1.0e-12 && (h > 0 || (h == 0 && k > 0)));
                    if (!first) continue;
                    const Vec3d g = combine(in_across / g_per_nm, across, in_along / g_per_nm, along, up / g_per_nm, axis);
                    const double amplitude = peak.separate_domains ? 1.0 : std::sqrt(peak.weight);
                    PlanePair pair{{float(g.x), float(g.y), float(g.z)},
                                   float(g_per_nm),
                                   float(amplitude * std::abs(sphere_form_factor(d_nm, g_per_nm))),
                                   h,
                                   k,
                                   layer};
                    if (peak.correlation < 1.0)
                        pair.coherence_nm = float(layers_nm * (1.0 + peak.correlation) / (1.0 - peak.correlation));
                    // The lattice's own layers step by (1,1,0)/sqrt2, a phase of (h + k) / 3 turns on the rod.
                    if (peak.separate_domains) pair.twin = (&peak == &blurred[0]) == ((h + k + 6 * limit) % 3 == 1) ? 1 : -1;
                    pairs.push_back(pair);
                }
    std::stable_sort(pairs.begin(), pairs.end(), [](const PlanePair& a, const PlanePair& b) { return a.g_per_nm < b.g_per_nm; });
    return pairs;
}

}  // namespace opal
