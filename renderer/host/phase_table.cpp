// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/phase_table.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "formats/units.h"

namespace opal {
namespace {

/// Below this contrast of indices a phase function no longer depends on it.
constexpr double least_contrast = 1.0e-6;
/// What refinement aims at: its test at midpoints can miss the largest error of an interval by less than this factor of 2.
constexpr double aimed_at = 0.5 * phase_table_accuracy;
constexpr double negligible_density = 1.0e-2 / (4.0 * units::pi);

struct MieSphere {
    MieCoefficients coefficients;
    double q_sca;

    double density(float cosine) const { return mie_phase_function(coefficients, q_sca, double(cosine)); }
};

MieSphere sphere_at(const CrystalDefect& defect, double wavelength_nm) {
    double index = defect.relative_index(wavelength_nm);
    if (std::abs(index - 1.0) < least_contrast) index = 1.0 + least_contrast;
    MieSphere sphere{mie_coefficients(defect.size_parameter(wavelength_nm), index), 0.0};
    sphere.q_sca = mie_efficiencies(sphere.coefficients).q_sca;
    return sphere;
}

/// A node and the densities of all wavelengths there.
struct Node {
    float cosine;
    std::vector<double> density;
};

/// The nodes at the given cosines.
std::vector<Node> evaluate(const std::vector<MieSphere>& spheres, const std::vector<float>& cosines) {
    std::vector<Node> nodes(cosines.size());
    tbb::parallel_for(std::size_t(0), cosines.size(), [&](std::size_t i) {
        nodes[i].cosine = cosines[i];
        for (const MieSphere& sphere : spheres) nodes[i].density.push_back(sphere.density(cosines[i]));
    });
    return nodes;
}

/// Even steps of the angle, some of them to each lobe of the smallest wavelength.
std::vector<float> first_cosines(double largest_size_parameter) {
    const int steps = 32 + int(8.0 * largest_size_parameter);
    std::vector<float> cosines;
    for (int i = steps; i >= 0; --i) cosines.push_back(float(std::cos(units::pi * i / steps)));
    cosines.front() = -1.0f;
    cosines.back() = 1.0f;
    cosines.erase(std::unique(cosines.begin(), cosines.end()), cosines.end());
    return cosines;
}

bool bends(const Node& before, const Node& middle, const Node& after) {
    for (std::size_t w = 0; w < middle.density.size(); ++w) {
        const double linear = 0.5 * (before.density[w] + after.density[w]);
        if (std::abs(middle.density[w] - linear) > aimed_at * std::max(middle.density[w], negligible_density)) return true;
    }
    return false;
}

/// Halves every interval until none bends at any wavelength, or floats cannot tell its middle from its ends.
std::vector<Node> refined_nodes(const std::vector<MieSphere>& spheres, double largest_size_parameter) {
    std::vector<Node> nodes = evaluate(spheres, first_cosines(largest_size_parameter));
    std::vector<std::size_t> open(nodes.size() - 1);
    for (std::size_t i = 0; i < open.size(); ++i) open[i] = i;
    while (!open.empty()) {
        std::vector<float> middles;
        for (const std::size_t i : open) middles.push_back(0.5f * (nodes[i].cosine + nodes[i + 1].cosine));
        std::vector<Node> middle_nodes = evaluate(spheres, middles);
        std::vector<Node> merged;
        std::vector<std::size_t> still_open;
        for (std::size_t i = 0, next = 0; i < nodes.size(); ++i) {
            merged.push_back(std::move(nodes[i]));
            if (next == open.size() || open[next] != i) continue;
            Node& middle = middle_nodes[next++];
            const bool apart = middle.cosine > merged.back().cosine && middle.cosine < nodes[i + 1].cosine;
            if (!apart || !bends(merged.back(), middle, nodes[i + 1])) continue;
            merged.push_back(std::move(middle));
            still_open.push_back(merged.size() - 2);
            still_open.push_back(merged.size() - 1);
        }
        nodes = std::move(merged);
        open = std::move(still_open);
    }
    return nodes;
}

/// One wavelength's row: densities scaled so that the linear pieces hold a probability of 1, and its sums.
void append_row(const std::vector<Node>& nodes, std::size_t wavelength, PhaseTable& table) {
    const auto width = [&](std::size_t i) { return double(nodes[i + 1].cosine) - double(nodes[i].cosine); };
    double total = 0.0;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
        total += units::pi * width(i) * (nodes[i].density[wavelength] + nodes[i + 1].density[wavelength]);
    double sum = 0.0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        table.density.push_back(float(nodes[i].density[wavelength] / total));
        table.cdf.push_back(i + 1 < nodes.size() ? float(sum / total) : 1.0f);
        if (i + 1 < nodes.size()) sum += units::pi * width(i) * (nodes[i].density[wavelength] + nodes[i + 1].density[wavelength]);
    }
}

}  // namespace

PhaseTableView PhaseTable::view() const {
    return {cosine.data(), density.data(), cdf.data(), int(cosine.size()), num_wavelengths, first_nm, step_nm};
}

double PhaseTable::mean_cosine(double wavelength_nm) const {
    double mean = 0.0;
    for (std::size_t i = 0; i + 1 < cosine.size(); ++i) {
        const double a = cosine[i], b = cosine[i + 1];
        const double p = phase_table_density(view(), cosine[i], float(wavelength_nm));
        const double q = phase_table_density(view(), cosine[i + 1], float(wavelength_nm));
        // Simpson's rule, exact for a linear density times the cosine.
        mean += 2.0 * units::pi * (b - a) / 6.0 * (p * a + (p + q) * (a + b) + q * b);
    }
    return mean;
}

PhaseTable make_mie_phase_table(const CrystalDefect& defect) {
    PhaseTable table;
    table.num_wavelengths = 1 + int(std::lround((units::wavelength_max_nm - units::wavelength_min_nm) / phase_table_step_nm));
    table.first_nm = float(units::wavelength_min_nm);
    table.step_nm = float(phase_table_step_nm);
    std::vector<MieSphere> spheres;
    for (int i = 0; i < table.num_wavelengths; ++i)
        spheres.push_back(sphere_at(defect, units::wavelength_min_nm + phase_table_step_nm * i));
    const std::vector<Node> nodes = refined_nodes(spheres, defect.size_parameter(units::wavelength_min_nm));
    for (const Node& node : nodes) table.cosine.push_back(node.cosine);
    for (std::size_t w = 0; w < spheres.size(); ++w) append_row(nodes, w, table);
    return table;
}

}  // namespace opal
