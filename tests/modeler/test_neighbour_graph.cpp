// SPDX-License-Identifier: Apache-2.0
#include "modeler/neighbour_graph.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <set>

#include "modeler/hidden_sites.h"
#include "modeler/labelling.h"
#include "modeler/sites.h"
#include "modeler/weights.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

using testing_tools::random_sites;

std::unique_ptr<Shape> ellipsoid(std::array<double, 3> size_mm) {
    ShapeRecipe recipe;
    recipe.size_mm = size_mm;
    return make_shape(recipe);
}

double spacing_of(const Shape& shape, std::size_t count) {
    return std::cbrt(shape.bounds_mm().volume() * 0.5236 / static_cast<double>(count));
}

/// Random sites inside the shape.
std::vector<Site> sites_inside(const Shape& shape, std::size_t count, double weight_spread_mm, std::uint64_t seed) {
    std::vector<Site> sites = random_sites(shape.bounds_mm(), 3 * count, weight_spread_mm, seed);
    std::erase_if(sites, [&](const Site& site) { return !shape.contains(site.position_mm); });
    sites.resize(std::min(count, sites.size()));
    return sites;
}

/// How many faces between voxels lie between each two sites' cells, in a fine labelling.
std::map<NeighbourPair, int> voxel_faces(const std::vector<Site>& sites, const Shape& shape, double voxel_size_mm) {
    std::vector<std::int32_t> labels(sites.size());
    std::iota(labels.begin(), labels.end(), 1);
    const auto grid = label_voxels(sites, labels, *shape.level_set(voxel_size_mm));
    auto values = grid->getConstAccessor();
    std::map<NeighbourPair, int> faces;
    for (const openvdb::Coord& voxel : grid->evalActiveVoxelBoundingBox()) {
        const std::int32_t here = values.getValue(voxel);
        if (here == 0) continue;
        for (const openvdb::Coord& step : {openvdb::Coord(1, 0, 0), openvdb::Coord(0, 1, 0), openvdb::Coord(0, 0, 1)}) {
            const std::int32_t there = values.getValue(voxel + step);
            if (there != 0 && there != here) ++faces[{std::min(here, there) - 1, std::max(here, there) - 1}];
        }
    }
    return faces;
}

void expect_the_labelling_s_neighbours(const std::vector<Site>& sites, const Shape& shape) {
    const double spacing = spacing_of(shape, sites.size());
    const std::vector<char> hidden = find_hidden_sites(sites);
    const NeighbourGraph graph = apollonius_graph(sites, hidden, shape, spacing);
    ASSERT_TRUE(std::is_sorted(graph.begin(), graph.end()));
    const std::map<NeighbourPair, int> faces = voxel_faces(sites, shape, spacing / 40.0);

    // Voxels can bridge a thin cell between two others, but not often: only contacts of several faces must be in the graph.
    std::size_t missed = 0, large_faces = 0;
    for (const auto& [pair, count] : faces) {
        ASSERT_EQ(hidden[std::size_t(pair.first)] + hidden[std::size_t(pair.second)], 0);
        if (count < 12) continue;
        ++large_faces;
        if (!std::binary_search(graph.begin(), graph.end(), pair)) ++missed;
    }
    EXPECT_GT(large_faces, 0u);
    EXPECT_EQ(missed, 0u) << "of " << large_faces;
    // Proven pairs that the voxels do not show have faces thinner than a voxel.
    const auto unseen =
        std::count_if(graph.begin(), graph.end(), [&](const NeighbourPair& pair) { return !faces.contains(pair); });
    EXPECT_LE(unseen, 1 + std::ssize(graph) / 40) << "of " << graph.size();
}

TEST(ApolloniusGraph, EqualsTheFacesOfAFineLabelling) {
    const auto shape = ellipsoid({5.0, 4.0, 3.0});
    for (const double spread : {0.0, 0.15, 0.6, 2.0}) {
        SCOPED_TRACE(spread);
        expect_the_labelling_s_neighbours(sites_inside(*shape, 40, spread, 8), *shape);
    }
}

TEST(ApolloniusGraph, TwoSitesAndOneAndNone) {
    const auto shape = ellipsoid({5.0, 4.0, 3.0});
    const std::vector<Site> sites = sites_inside(*shape, 2, 0.1, 1);
    EXPECT_EQ(apollonius_graph(sites, {0, 0}, *shape, 2.0), (NeighbourGraph{{0, 1}}));
    EXPECT_TRUE(apollonius_graph(sites, {0, 1}, *shape, 2.0).empty());
    EXPECT_TRUE(apollonius_graph({sites[0]}, {0}, *shape, 2.0).empty());
}

TEST(ApolloniusGraph, CellsThatTouchAtEdgesOnlyAreNoNeighbours) {
    // The cells of a cubic lattice: 6 neighbours share a face; 12 share an edge and 8 a corner, which are no faces.
    ShapeRecipe recipe;
    recipe.kind = ShapeKind::box;
    recipe.size_mm = {4.0, 4.0, 4.0};
    std::vector<Site> sites;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            for (int k = 0; k < 4; ++k) sites.push_back({openvdb::Vec3d(i - 1.5, j - 1.5, k + 0.5), 0.25f, 0});
    const NeighbourGraph graph = apollonius_graph(sites, std::vector<char>(64, 0), *make_shape(recipe), 1.0);
    EXPECT_EQ(graph.size(), 3u * 3u * 16u);
    for (const NeighbourPair& pair : graph)
        EXPECT_DOUBLE_EQ((sites[std::size_t(pair.first)].position_mm - sites[std::size_t(pair.second)].position_mm).length(),
                         1.0);
}

TEST(ApolloniusGraph, WithoutWeightsIsDelaunaysInTheInterior) {
    const auto shape = ellipsoid({6.0, 6.0, 6.0});
    const SiteSet set = sample_sites(*shape, 2000, 5);
    GrainsRecipe recipe;
    recipe.weight[0].kind = WeightKind::none;
    const std::vector<Site> sites = weigh_sites(set, recipe, *shape).sites;
    const std::vector<char> hidden(sites.size(), 0);
    const NeighbourGraph apollonius = apollonius_graph(sites, hidden, *shape, set.spacing_mm());
    const NeighbourGraph delaunay = delaunay_graph(sites, hidden);
    EXPECT_TRUE(std::includes(delaunay.begin(), delaunay.end(), apollonius.begin(), apollonius.end()));

    std::size_t interior = 0, missed = 0;
    for (const NeighbourPair& pair : delaunay) {
        const auto deep = [&](std::int32_t site) {
            return shape->signed_distance_mm(sites[std::size_t(site)].position_mm) < -1.5 * set.spacing_mm();
        };
        if (!deep(pair.first) || !deep(pair.second)) continue;
        ++interior;
        missed += std::binary_search(apollonius.begin(), apollonius.end(), pair) ? 0 : 1;
    }
    EXPECT_GT(interior, 3000u);
    EXPECT_LE(double(missed), 0.002 * double(interior)) << missed << " of " << interior;
}

/// Sites some millimetres across in a wide shape: from most of it their distances change almost alike. Culled by the ball alone,
/// all of them might own most of it, and the search comes to 42 million cubes (multiplicative, Manhattan).
TEST(ApolloniusGraph, FewSitesInAWideShapeTakeFewCubes) {
    ShapeRecipe recipe;
    recipe.kind = ShapeKind::cabochon;
    recipe.size_mm = {400.0, 400.0, 200.0};
    const auto shape = make_shape(recipe);
    std::vector<Site> sites;
    for (int i = 0; i < 27; ++i)
        sites.push_back({openvdb::Vec3d(i % 3 - 1, i / 3 % 3 - 1 + 0.1 * (i % 2), i / 9 - 1), 1.0f + 0.01f * float(i % 7), 0});
    const std::vector<char> hidden(sites.size(), 0);
    // Half of the sites are below the cabochon's base.
    const double spacing = 2.0 * spacing_of(*shape, sites.size());
    for (const TessellationKind kind :
         {TessellationKind::additive, TessellationKind::multiplicative, TessellationKind::manhattan}) {
        std::atomic<std::uint64_t> cubes = 0;
        const NeighbourGraph graph = apollonius_graph(sites, hidden, *shape, spacing, kind, &cubes);
        // Every site has a face with another.
        std::set<std::int32_t> joined;
        for (const NeighbourPair& pair : graph) joined.insert({pair.first, pair.second});
        EXPECT_GE(joined.size(), 18u) << int(kind);
        EXPECT_LT(cubes, 10'000'000u) << int(kind);
    }
}

TEST(ApolloniusGraph, DoesNotDependOnThreads) {
    const auto shape = ellipsoid({6.0, 5.0, 4.0});
    const std::vector<Site> sites = sites_inside(*shape, 500, 0.1, 2);
    const double spacing = spacing_of(*shape, sites.size());
    const std::vector<char> hidden = find_hidden_sites(sites);
    const auto build = [&] { return apollonius_graph(sites, hidden, *shape, spacing); };
    EXPECT_EQ(testing_tools::with_threads(1, build), testing_tools::with_threads(2, build));
}

TEST(DelaunayGraph, OfFewSites) {
    std::vector<Site> sites(5);
    sites[1].position_mm = {1.0, 0.0, 0.0};
    sites[2].position_mm = {0.0, 1.0, 0.0};
    sites[3].position_mm = {0.0, 0.0, 1.0};
    sites[4].position_mm = {0.1, 0.1, 0.1};
    EXPECT_EQ(delaunay_graph(sites, {0, 0, 0, 0, 0}).size(), 10u);  // a point inside a tetrahedron: all pairs
    EXPECT_EQ(delaunay_graph(sites, {0, 0, 0, 0, 1}).size(), 6u);
    EXPECT_EQ(delaunay_graph(sites, {0, 0, 1, 1, 1}), (NeighbourGraph{{0, 1}}));
    EXPECT_TRUE(delaunay_graph(sites, {0, 1, 1, 1, 1}).empty());
}

std::vector<Site> sites_at(const std::vector<openvdb::Vec3d>& positions_mm) {
    std::vector<Site> sites;
    for (const openvdb::Vec3d& position_mm : positions_mm) sites.push_back({position_mm, 0.0f, 0});
    return sites;
}

NeighbourGraph delaunay_of(const std::vector<openvdb::Vec3d>& positions_mm) {
    return delaunay_graph(sites_at(positions_mm), std::vector<char>(positions_mm.size(), 0));
}

TEST(DelaunayGraph, OfSitesOnALineAndInAPlane) {
    EXPECT_TRUE(delaunay_of({}).empty());
    EXPECT_TRUE(delaunay_of({{1, 2, 3}}).empty());
    EXPECT_EQ(delaunay_of({{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}), (NeighbourGraph{{0, 2}, {1, 2}}));
    EXPECT_EQ(delaunay_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), (NeighbourGraph{{0, 1}, {0, 2}, {1, 2}}));
    // A kite: of its two diagonals the Delaunay triangulation takes the short one.
    EXPECT_EQ(delaunay_of({{-3, 0, 1}, {0, 1, 1}, {3, 0, 1}, {0, -1, 1}}),
              (NeighbourGraph{{0, 1}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}));
    EXPECT_EQ(delaunay_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}).size(), 5u);  // a square, with either diagonal
}

TEST(DelaunayGraph, SitesAtTheSamePlaceAreNeighboursOfTheLowest) {
    EXPECT_EQ(delaunay_of({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}), (NeighbourGraph{{0, 1}, {0, 2}}));
    const std::vector<openvdb::Vec3d> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    EXPECT_EQ(delaunay_of(corners), (NeighbourGraph{{0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 2}, {1, 3}, {2, 3}}));
    EXPECT_EQ(delaunay_graph(sites_at(corners), {1, 0, 0, 0, 0}),
              (NeighbourGraph{{1, 2}, {1, 3}, {1, 4}, {2, 3}, {2, 4}, {3, 4}}));
}

TEST(DelaunayGraph, OfACosphericalLatticeDependsOnPlacesAlone) {
    std::vector<openvdb::Vec3d> lattice;
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 5; ++j)
            for (int k = 0; k < 5; ++k) lattice.emplace_back(0.1 * i, 0.1 * j, 0.1 * k);
    const NeighbourGraph graph = delaunay_of(lattice);
    // Every edge of the lattice is there, and no edge is longer than the diagonal of a cell.
    std::size_t lattice_edges = 0;
    for (const NeighbourPair& pair : graph) {
        const double length = (lattice[std::size_t(pair.first)] - lattice[std::size_t(pair.second)]).length();
        EXPECT_LT(length, 0.1 * std::sqrt(3.0) + 1e-9);
        lattice_edges += length < 0.1 + 1e-9 ? 1 : 0;
    }
    EXPECT_EQ(lattice_edges, 300u);
    // The same places in another order: 37 is coprime to 125.
    std::vector<openvdb::Vec3d> shuffled;
    for (std::size_t n = 0; n < 125; ++n) shuffled.push_back(lattice[37 * n % 125]);
    NeighbourGraph renumbered;
    for (const NeighbourPair& pair : delaunay_of(shuffled)) {
        const auto a = std::int32_t(37 * pair.first % 125), b = std::int32_t(37 * pair.second % 125);
        renumbered.push_back({std::min(a, b), std::max(a, b)});
    }
    std::sort(renumbered.begin(), renumbered.end());
    EXPECT_EQ(renumbered, graph);
}

TEST(LatticeGraph, JoinsCellsOneStepApart) {
    // A row of three, one beside its middle, one across a corner, one two steps away.
    const std::vector<openvdb::Coord> cells = {{1, 0, 0}, {0, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {1, 1, 1}, {3, 0, 0}};
    EXPECT_EQ(lattice_graph(cells, {0, 0, 0, 0, 0, 0}), (NeighbourGraph{{0, 1}, {1, 2}, {1, 3}}));
    EXPECT_EQ(lattice_graph(cells, {0, 1, 0, 0, 0, 0}), NeighbourGraph{});
    EXPECT_TRUE(lattice_graph({}, {}).empty());
}

TEST(LatticeGraph, OfABlockHasThreeNSquaredNMinusOneBonds) {
    std::vector<openvdb::Coord> cells;
    for (int i = 0; i < 7; ++i)
        for (int j = 0; j < 7; ++j)
            for (int k = 0; k < 7; ++k) cells.emplace_back(k - 3, j - 3, i - 3);
    const NeighbourGraph graph = lattice_graph(cells, std::vector<char>(343, 0));
    EXPECT_EQ(graph.size(), 3u * 49u * 6u);
    EXPECT_TRUE(std::is_sorted(graph.begin(), graph.end()));
    for (const NeighbourPair& pair : graph) {
        const openvdb::Coord step = cells[std::size_t(pair.second)] - cells[std::size_t(pair.first)];
        EXPECT_EQ(std::abs(step.x()) + std::abs(step.y()) + std::abs(step.z()), 1);
    }
}

}  // namespace
}  // namespace opal
