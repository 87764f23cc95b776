// SPDX-License-Identifier: Apache-2.0
#include "modeler/percolation.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "modeler/percolation_plot.h"
#include "modeler/sintering.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

NeighbourGraph block_of(std::int32_t n) {
    std::vector<openvdb::Coord> cells;
    for (std::int32_t i = 0; i < n * n * n; ++i) cells.emplace_back(i / (n * n), i / n % n, i % n);
    return lattice_graph(cells, std::vector<char>(cells.size(), 0));
}

TEST(Percolation, OfATreeIsExact) {
    // Every bond of a tree joins two grains: N_n = sites - n, so N(p) = sites - M p for any order of the bonds.
    NeighbourGraph tree;
    for (std::int32_t n = 1; n < 5000; ++n) tree.push_back({(n - 1) / 3, n});
    std::sort(tree.begin(), tree.end());
    const std::vector<char> hidden(5000, 0);
    const PercolationCurve curve = percolation_curve(BondOrder(tree, {}, 1), hidden);
    EXPECT_GE(curve.points.size(), 201u);
    for (const PercolationPoint& point : curve.points) ASSERT_NEAR(point.grains, 5000.0 - 4999.0 * point.p, 1e-8) << point.p;
    EXPECT_EQ(curve.points.front().p, 0.0);
    EXPECT_EQ(curve.points.back().p, 1.0);
}

TEST(Percolation, OfTwoSitesIsExact) {
    const PercolationCurve curve = percolation_curve(BondOrder({{0, 1}}, {}, 1), {0, 0, 1});
    for (const PercolationPoint& point : curve.points) {
        EXPECT_NEAR(point.grains, 2.0 - point.p, 1e-14);
        EXPECT_NEAR(point.largest_fraction, 0.5 * (1.0 + point.p), 1e-14);
        EXPECT_NEAR(point.mean_other_size, 0.5 * (1.0 - point.p), 1e-14);
    }
    EXPECT_FALSE(curve.threshold.has_value());  // the one grain left is the largest
}

/// A cube's 8 corners and 12 edges: all 4096 sets of kept bonds give E[N] and E[largest] exactly. Averaged over 2000 sweeps,
/// whose scatter gives the standard error; five of those are allowed.
TEST(Percolation, OfACubeEqualsTheEnumeration) {
    const NeighbourGraph graph = block_of(2);
    ASSERT_EQ(graph.size(), 12u);
    std::vector<double> grains_of(13, 0.0), largest_of(13, 0.0);  // summed over sets of so many bonds
    for (unsigned set = 0; set < 4096; ++set) {
        UnionFind clusters(8);
        std::size_t grains = 8, largest = 1, kept = 0;
        for (std::size_t n = 0; n < 12; ++n) {
            if ((set >> n & 1u) == 0) continue;
            ++kept;
            const std::size_t a = clusters.root(std::size_t(graph[n].first)), b = clusters.root(std::size_t(graph[n].second));
            if (a == b) continue;
            --grains;
            largest = std::max(largest, clusters.join(a, b));
        }
        grains_of[kept] += double(grains);
        largest_of[kept] += double(largest) / 8.0;
    }
    const std::vector<double> probabilities = {0.05, 0.2, 0.25, 0.5, 0.9};
    std::vector<double> sum(10, 0.0), squares(10, 0.0);
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
        const PercolationCurve curve = percolation_curve(BondOrder(graph, {}, seed), std::vector<char>(8, 0));
        for (std::size_t k = 0; k < 5; ++k) {
            const double p = probabilities[k];
            const auto point = std::find_if(curve.points.begin(), curve.points.end(), [&](const auto& q) { return q.p == p; });
            ASSERT_NE(point, curve.points.end());
            double error[2] = {point->grains, point->largest_fraction};
            for (std::size_t n = 0; n <= 12; ++n) {
                const double chance = std::pow(p, double(n)) * std::pow(1.0 - p, 12.0 - double(n));
                error[0] -= chance * grains_of[n];
                error[1] -= chance * largest_of[n];
            }
            for (std::size_t q = 0; q < 2; ++q) {
                sum[2 * k + q] += error[q];
                squares[2 * k + q] += error[q] * error[q];
            }
        }
    }
    for (std::size_t k = 0; k < 10; ++k) EXPECT_LT(std::abs(sum[k]), 5.0 * std::sqrt(squares[k])) << k;
}

TEST(Percolation, WeightedCurveIsWhatSinteringKeeps) {
    const NeighbourGraph graph = block_of(6);
    std::vector<double> weights;
    for (std::size_t n = 0; n < graph.size(); ++n) weights.push_back(0.1 + 0.3 * double(n % 7));
    const std::vector<char> hidden(216, 0);
    const PercolationCurve curve = percolation_curve(BondOrder(graph, weights, 4), hidden);
    for (const PercolationPoint& point : curve.points) {
        SinteringRecipe recipe;
        recipe.probability = point.p;
        const Sintering result = sinter(graph, hidden, recipe, 4, weights);
        ASSERT_EQ(point.grains, result.num_grains) << point.p;
        ASSERT_EQ(point.largest_fraction, result.largest_grain_fraction) << point.p;
        ASSERT_EQ(curve.threshold, result.threshold);
    }
}

TEST(Percolation, DoesNotDependOnThreads) {
    const NeighbourGraph graph = block_of(12);
    const std::vector<char> hidden(1728, 0);
    const auto csv = [&] { return percolation_csv(percolation_curve(BondOrder(graph, {}, 9), hidden), 1728, {"note"}); };
    const std::string one = testing_tools::with_threads(1, csv);
    EXPECT_EQ(one, testing_tools::with_threads(2, csv));
    std::istringstream lines(one);
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "# note");
    std::getline(lines, line);
    EXPECT_EQ(line.rfind("# threshold 0.2", 0), 0u) << line;
    std::getline(lines, line);
    EXPECT_EQ(line, "p,grains,grains_per_site,largest_fraction,mean_other_size");
    std::getline(lines, line);
    EXPECT_EQ(line.rfind("0,1728,1,", 0), 0u) << line;
}

TEST(Percolation, PlotShowsTwoCurvesAndTheThreshold) {
    const NeighbourGraph graph = block_of(12);
    const std::vector<char> hidden(1728, 0);
    const Image image =
        draw_percolation_plot({percolation_curve(BondOrder(graph, {}, 9), hidden), 1728, "Grains of 1728 sites", 0.2});
    ASSERT_EQ(image.num_channels(), 3);
    // The curves' colours, blue and orange, and the threshold's grey; paper in the corner.
    std::size_t blue = 0, orange = 0, paper = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float* p = image.pixel(x, y);
            blue += p[2] > p[0] + 0.3f ? 1 : 0;
            orange += p[0] > p[2] + 0.3f ? 1 : 0;
            paper += p[0] == 1.0f && p[1] == 1.0f && p[2] == 1.0f ? 1 : 0;
        }
    EXPECT_GT(blue, 1000u);
    EXPECT_GT(orange, 1000u);
    EXPECT_GT(double(paper), 0.85 * image.width * image.height);
    EXPECT_EQ(image.pixel(0, 0)[0], 1.0f);
}

}  // namespace
}  // namespace opal
