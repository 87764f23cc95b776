// SPDX-License-Identifier: Apache-2.0
#include "modeler/sintering.h"

#include <algorithm>
#include <cmath>

#include "formats/random.h"
#include "modeler/sites.h"
#include "modeler/union_find.h"
#include "modeler/weights.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

SinteringRecipe with_probability(double p) {
    SinteringRecipe recipe;
    recipe.probability = p;
    return recipe;
}

SinteringRecipe with_grains(std::int64_t grains) {
    SinteringRecipe recipe;
    recipe.target_grains = grains;
    return recipe;
}

/// n x n x n sites, 6 neighbours each.
NeighbourGraph cubic_lattice(std::int32_t n) {
    NeighbourGraph graph;
    const auto id = [n](std::int32_t i, std::int32_t j, std::int32_t k) { return (i * n + j) * n + k; };
    for (std::int32_t i = 0; i < n; ++i)
        for (std::int32_t j = 0; j < n; ++j)
            for (std::int32_t k = 0; k < n; ++k) {
                if (k + 1 < n) graph.push_back({id(i, j, k), id(i, j, k + 1)});
                if (j + 1 < n) graph.push_back({id(i, j, k), id(i, j + 1, k)});
                if (i + 1 < n) graph.push_back({id(i, j, k), id(i + 1, j, k)});
            }
    std::sort(graph.begin(), graph.end());
    return graph;
}

TEST(Sintering, ProbabilityZeroKeepsSitesApartAndOneJoinsThem) {
    const NeighbourGraph graph = cubic_lattice(5);
    const std::vector<char> hidden(125, 0);
    const Sintering apart = sinter(graph, hidden, with_probability(0.0), 1);
    EXPECT_EQ(apart.num_grains, 125);
    EXPECT_EQ(apart.num_kept_bonds, 0u);
    for (std::int32_t n = 0; n < 125; ++n) EXPECT_EQ(apart.grain_of_site[std::size_t(n)], n + 1);
    const Sintering together = sinter(graph, hidden, with_probability(1.0), 1);
    EXPECT_EQ(together.num_grains, 1);
    EXPECT_EQ(together.num_kept_bonds, graph.size());
    EXPECT_DOUBLE_EQ(together.largest_grain_fraction, 1.0);
}

TEST(Sintering, ReachesEveryNumberOfGrains) {
    const NeighbourGraph graph = cubic_lattice(4);
    const std::vector<char> hidden(64, 0);
    for (std::int64_t grains = 1; grains <= 64; ++grains) {
        const Sintering result = sinter(graph, hidden, with_grains(grains), 7);
        ASSERT_EQ(result.num_grains, grains);
        ASSERT_NEAR(result.probability, double(result.num_kept_bonds) / double(graph.size()), 1e-15);
    }
}

TEST(Sintering, NamesTheRangeOfReachableNumbers) {
    const NeighbourGraph two_pairs = {{0, 1}, {2, 3}};
    const std::vector<char> hidden = {0, 0, 0, 0, 1};
    for (const std::int64_t grains : {1, 5}) {
        const auto message = testing_tools::input_error_of([&] { sinter(two_pairs, hidden, with_grains(grains), 1); });
        EXPECT_NE(message.find("cannot be reached: these 4 sites can form 2 to 4 grains"), std::string::npos) << message;
    }
}

TEST(Sintering, KeepsExactlyTheBondsWhoseRandomNumberLiesBelowP) {
    const NeighbourGraph graph = cubic_lattice(9);
    const std::vector<char> hidden(729, 0);
    UnionFind clusters(729);
    std::size_t kept = 0;
    for (const NeighbourPair& pair : graph) {
        const RandomBlock block =
            random_block(5, RandomStream::sintering_bonds, (std::uint64_t(pair.first) << 32) | std::uint64_t(pair.second), 0);
        if (!(uniform_double(block.value[0], block.value[1]) < 0.21)) continue;
        ++kept;
        const std::size_t a = clusters.root(std::size_t(pair.first)), b = clusters.root(std::size_t(pair.second));
        if (a != b) clusters.join(a, b);
    }
    const Sintering result = sinter(graph, hidden, with_probability(0.21), 5);
    EXPECT_EQ(result.num_kept_bonds, kept);
    for (std::size_t a = 0; a < 729; ++a)
        for (std::size_t b = 0; b < a; ++b)
            ASSERT_EQ(result.grain_of_site[a] == result.grain_of_site[b], clusters.root(a) == clusters.root(b));
}

TEST(Sintering, MeanGrainSizeBecomesANumberOfGrains) {
    const NeighbourGraph graph = cubic_lattice(10);
    const std::vector<char> hidden(1000, 0);
    SinteringRecipe recipe;
    recipe.mean_grain_mm = 1.2;
    // 500 mm^3 / (pi / 6 * 1.2^3 mm^3) = 552.6
    EXPECT_EQ(sinter(graph, hidden, recipe, 1, {}, 500.0).num_grains, 553);
    recipe.mean_grain_mm = 20.0;  // 0.1 grains: nothing is larger than the whole
    EXPECT_EQ(sinter(graph, hidden, recipe, 1, {}, 500.0).num_grains, 1);
    recipe.mean_grain_mm = 0.5;
    const auto message = testing_tools::input_error_of([&] { sinter(graph, hidden, recipe, 1, {}, 500.0); });
    EXPECT_NE(message.find("grains.sintering.mean_grain_mm = 0.5 cannot be reached: these 1000 sites can form 1 to 1000 grains, "
                           "0.9847 to 9.847 mm across"),
              std::string::npos)
        << message;
}

TEST(Sintering, WeightsOfOneKeepTheVerySameBonds) {
    const NeighbourGraph graph = cubic_lattice(12);
    const std::vector<char> hidden(1728, 0);
    const std::vector<double> ones(graph.size(), 1.0);
    for (const double p : {0.0, 0.1, 0.25, 0.7, 1.0}) {
        const Sintering plain = sinter(graph, hidden, with_probability(p), 11);
        const Sintering weighted = sinter(graph, hidden, with_probability(p), 11, ones);
        EXPECT_EQ(plain.num_kept_bonds, weighted.num_kept_bonds);
        EXPECT_EQ(plain.grain_of_site, weighted.grain_of_site);
    }
    EXPECT_EQ(sinter(graph, hidden, with_grains(500), 11).grain_of_site,
              sinter(graph, hidden, with_grains(500), 11, ones).grain_of_site);
}

TEST(Sintering, WeightedBondsAreKeptByTheLawOfTheRace) {
    // 100,000 pairs of sites without further neighbours: each keeps its bond with probability 1 - (1 - p)^omega.
    const std::int32_t pairs = 100'000;
    NeighbourGraph graph;
    for (std::int32_t n = 0; n < pairs; ++n) graph.push_back({2 * n, 2 * n + 1});
    const std::vector<char> hidden(2 * std::size_t(pairs), 0);
    for (const double omega : {0.0, 0.3, 2.5})
        for (const double p : {0.1, 0.6}) {
            const double expected = 1.0 - std::pow(1.0 - p, omega);
            const Sintering result = sinter(graph, hidden, with_probability(p), 3, std::vector<double>(graph.size(), omega));
            EXPECT_NEAR(double(result.num_kept_bonds) / pairs, expected, 4.0 * std::sqrt(expected * (1.0 - expected) / pairs));
        }
}

TEST(Sintering, BondsOfWeightZeroAreNeverKept) {
    const NeighbourGraph graph = {{0, 1}, {1, 2}, {2, 3}};
    const std::vector<double> weights = {1.0, 0.0, 1.0};
    EXPECT_EQ(sinter(graph, {0, 0, 0, 0}, with_probability(1.0), 1, weights).grain_of_site,
              (std::vector<std::int32_t>{1, 1, 2, 2}));
    const auto message = testing_tools::input_error_of([&] { sinter(graph, {0, 0, 0, 0}, with_grains(1), 1, weights); });
    EXPECT_NE(message.find("can form 2 to 4 grains"), std::string::npos) << message;
}

TEST(Sintering, DoesNotDependOnThreads) {
    const NeighbourGraph graph = cubic_lattice(20);
    const std::vector<char> hidden(8000, 0);
    const auto run = [&] { return sinter(graph, hidden, with_probability(0.24), 2).grain_of_site; };
    EXPECT_EQ(testing_tools::with_threads(1, run), testing_tools::with_threads(2, run));
}

TEST(Sintering, HiddenSitesBelongToNoGrainAndNumbersFollowTheLowestSite) {
    const NeighbourGraph graph = {{0, 4}, {1, 2}};
    const Sintering result = sinter(graph, {0, 0, 0, 1, 0}, with_probability(1.0), 1);
    EXPECT_EQ(result.grain_of_site, (std::vector<std::int32_t>{1, 2, 2, 0, 1}));
    EXPECT_EQ(result.num_grains, 2);
    EXPECT_DOUBLE_EQ(result.largest_grain_fraction, 0.5);
}

TEST(Sintering, HigherProbabilityOnlyJoinsGrains) {
    const NeighbourGraph graph = cubic_lattice(8);
    const std::vector<char> hidden(512, 0);
    const Sintering few = sinter(graph, hidden, with_probability(0.2), 3), many = sinter(graph, hidden, with_probability(0.3), 3);
    EXPECT_LT(many.num_grains, few.num_grains);
    for (const NeighbourPair& pair : graph) {
        const auto a = std::size_t(pair.first), b = std::size_t(pair.second);
        EXPECT_TRUE(few.grain_of_site[a] != few.grain_of_site[b] || many.grain_of_site[a] == many.grain_of_site[b]);
    }
}

TEST(Sintering, WithoutBondsThereIsNoThreshold) {
    const Sintering result = sinter({}, {0, 0}, with_probability(0.5), 1);
    EXPECT_EQ(result.num_grains, 2);
    EXPECT_FALSE(result.threshold.has_value());
}

/// Rows cubic_30 of ../shared/reference/percolation.csv (a simulation of its own). The number of kept bonds M p has standard
/// deviation sqrt(M p (1 - p)) <= 131 of 78,300 bonds, and a bond joins at most two grains: per site at most 0.0048 for each of
/// the two simulations, 0.0069 for their difference; four of these are allowed. The largest grain is noisier only at the
/// threshold.
TEST(Sintering, CubicLatticeEqualsTheReference) {
    const NeighbourGraph graph = cubic_lattice(30);
    const std::vector<char> hidden(27'000, 0);
    const double rows[3][3] = {{0.12, 0.6570, 0.0010}, {0.22, 0.3661, 0.0150}, {0.32, 0.1567, 0.7230}};
    for (const auto& [p, grains_per_site, largest] : rows) {
        const Sintering result = sinter(graph, hidden, with_probability(p), 1);
        EXPECT_NEAR(result.num_grains / 27'000.0, grains_per_site, 4.0 * 0.0069);
        EXPECT_NEAR(result.largest_grain_fraction, largest, 0.03);
        EXPECT_NEAR(result.threshold.value(), 0.2488,
                    0.03);  // the infinite lattice's; 30^(-1/0.88) = 0.02 of shift for this size
    }
}

/// Rows poisson_disk_delaunay of the same file: 27,000 sites. As above, M = 205,000 bonds: standard deviation of the kept ones at
/// most sqrt(205,000 * 0.22 * 0.78) = 188, 0.007 per site; measured spreads are a third of that. The two bodies' surfaces differ,
/// which changes the mean degree by about 2 %: 0.008 grains per site.
TEST(Sintering, DelaunayGraphEqualsTheReference) {
    ShapeRecipe cube;
    cube.kind = ShapeKind::box;
    cube.size_mm = {10.0, 10.0, 10.0};
    const auto shape = make_shape(cube);
    const SiteSet set = sample_sites(*shape, 27'000, 1);
    GrainsRecipe recipe;
    recipe.weight[0].kind = WeightKind::none;
    const std::vector<char> hidden(27'000, 0);
    const NeighbourGraph graph = delaunay_graph(weigh_sites(set, recipe, *shape).sites, hidden);
    EXPECT_NEAR(2.0 * double(graph.size()) / 27'000.0, 15.2, 0.3);
    const double rows[4][3] = {{0.05, 0.628, 0.0017}, {0.07, 0.479, 0.0109}, {0.12, 0.196, 0.7108}, {0.22, 0.031, 0.9664}};
    for (const auto& [p, grains_per_site, largest] : rows) {
        const Sintering result = sinter(graph, hidden, with_probability(p), 1);
        EXPECT_NEAR(result.num_grains / 27'000.0, grains_per_site, 0.018) << p;
        EXPECT_NEAR(result.largest_grain_fraction, largest, 0.04) << p;
        EXPECT_NEAR(result.threshold.value(), 0.0850, 0.01);
    }
}

}  // namespace
}  // namespace opal
