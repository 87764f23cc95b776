// SPDX-License-Identifier: Apache-2.0
// Sites, weights and sizes at the edge of what they can be; each test says what comes out.
#include <algorithm>
#include <cmath>
#include <set>

#include "labelling_test_tools.h"
#include "modeler/hidden_sites.h"

namespace opal {
namespace {

using testing_tools::expect_searched_labels;
using testing_tools::one_label_each;
using testing_tools::random_point;
using testing_tools::random_sites;
using testing_tools::shape_of;

constexpr std::array<TessellationKind, 3> metrics = {TessellationKind::additive, TessellationKind::multiplicative,
                                                     TessellationKind::manhattan};

std::vector<Site> sites_at(const std::vector<openvdb::Vec3d>& places, float weight = 1.0f) {
    std::vector<Site> sites(places.size());
    for (std::size_t n = 0; n < places.size(); ++n) {
        sites[n].position_mm = places[n];
        sites[n].weight_mm = weight;
    }
    return sites;
}

/// Labels a sphere of 4 mm and compares with a search through all sites; returns the labels that occur.
std::set<std::int32_t> labels_in_sphere(const std::vector<Site>& sites, TessellationKind kind) {
    const auto level_set = shape_of(ShapeKind::sphere, {4.0, 4.0, 4.0})->level_set(0.1);
    const std::vector<std::int32_t> labels = one_label_each(sites);
    const auto grid = label_voxels(sites, labels, *level_set, {kind, {}, 0});
    expect_searched_labels(*grid, *level_set, sites, labels, {kind, {}, 0});
    std::set<std::int32_t> seen;
    for (auto value = grid->cbeginValueOn(); value; ++value) seen.insert(*value);
    return seen;
}

std::size_t hidden_count(const std::vector<Site>& sites, TessellationKind kind) {
    const std::vector<char> hidden = find_hidden_sites(sites, kind);
    return std::size_t(std::count(hidden.begin(), hidden.end(), 1));
}

/// Equal weights, whatever they are, hide nobody, and every site owns voxels.
TEST(ExtremeWeights, AllEqual) {
    const openvdb::BBoxd box(openvdb::Vec3d(-1.0, -1.0, 1.0), openvdb::Vec3d(1.0, 1.0, 3.0));
    for (const TessellationKind kind : metrics)
        for (const float weight : {1.0e-6f, 1.0f, 1.0e6f}) {
            std::vector<Site> sites = random_sites(box, 40, 0.0, 3);
            for (Site& site : sites) site.weight_mm = weight;
            EXPECT_EQ(hidden_count(sites, kind), 0u);
            EXPECT_EQ(labels_in_sphere(sites, kind).size(), 40u);
        }
}

/// Weights that differ by 1e-7 mm decide ties between equally near sites, exactly.
TEST(ExtremeWeights, DifferingByAlmostNothing) {
    std::vector<Site> sites = sites_at({{-1.0, 0.0, 2.0}, {1.0, 0.0, 2.0}});
    const auto level_set = shape_of(ShapeKind::sphere, {4.0, 4.0, 4.0})->level_set(0.1);
    const auto label_in_the_middle = [&](TessellationKind kind) {
        return label_voxels(sites, {1, 2}, *level_set, {kind, {}, 0})->tree().getValue({0, 3, 22});
    };
    for (const TessellationKind kind : metrics) {
        EXPECT_EQ(label_in_the_middle(kind), 1);
        const float nudge = kind == TessellationKind::multiplicative ? -1.0e-7f : 1.2e-7f;
        sites[1].weight_mm = 1.0f + nudge;
        EXPECT_EQ(label_in_the_middle(kind), 2);
        EXPECT_EQ(hidden_count(sites, kind), 0u);
        EXPECT_EQ(labels_in_sphere(sites, kind), (std::set<std::int32_t>{1, 2}));
        sites[1].weight_mm = 1.0f;
    }
}

/// Weights a hundred times the spacing apart leave a few sites, which own everything; what is hidden owns no voxel.
TEST(ExtremeWeights, FarApart) {
    const openvdb::BBoxd box(openvdb::Vec3d(-2.0, -2.0, 0.0), openvdb::Vec3d(2.0, 2.0, 4.0));
    for (const TessellationKind kind : {TessellationKind::additive, TessellationKind::manhattan}) {
        const std::vector<Site> sites = random_sites(box, 500, 50.0, 3);
        const std::vector<char> hidden = find_hidden_sites(sites, kind);
        EXPECT_GT(std::count(hidden.begin(), hidden.end(), 1), 450);
        EXPECT_LT(std::count(hidden.begin(), hidden.end(), 1), 500);
        for (const std::int32_t label : labels_in_sphere(sites, kind)) EXPECT_EQ(hidden[std::size_t(label) - 1], 0);
    }
    std::vector<Site> factors = random_sites(box, 500, 40.0, 3);
    for (Site& site : factors) site.weight_mm = std::exp(site.weight_mm);
    EXPECT_EQ(hidden_count(factors, TessellationKind::multiplicative), 0u);
    EXPECT_GE(labels_in_sphere(factors, TessellationKind::multiplicative).size(), 1u);
}

/// One to four sites in a plane, a cube's corners around its centre, a lattice's points: all ties go to the lowest index.
TEST(DegenerateSites, FewCoplanarAndCospherical) {
    const openvdb::Vec3d middle(0.0, 0.0, 2.0);
    std::vector<std::vector<openvdb::Vec3d>> sets;
    for (std::size_t count = 1; count <= 4; ++count) {
        const std::vector<openvdb::Vec3d> coplanar = {{1, 0, 2}, {-1, 0, 2}, {0, 1, 2}, {0, -1, 2}};
        sets.emplace_back(coplanar.begin(), coplanar.begin() + std::ptrdiff_t(count));
    }
    sets.push_back({{0, 0, 1}, {0, 0, 2}, {0, 0, 3}});
    sets.emplace_back();
    for (int corner = 0; corner < 8; ++corner)
        sets.back().push_back(middle + openvdb::Vec3d(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
    sets.emplace_back();
    for (const openvdb::Coord& point : openvdb::CoordBBox({-1, -1, -1}, {1, 1, 1}))
        sets.back().push_back(middle + point.asVec3d());
    for (const auto& places : sets)
        for (const TessellationKind kind : metrics) {
            const std::vector<Site> sites = sites_at(places);
            EXPECT_EQ(hidden_count(sites, kind), 0u);
            EXPECT_EQ(labels_in_sphere(sites, kind).size(), places.size());
        }
}

/// Of sites in one place the strongest owns what there is, of equal ones the first; the others are hidden. (At the place itself
/// all factors are equally near.)
TEST(DegenerateSites, Duplicates) {
    for (const TessellationKind kind : metrics) {
        std::vector<Site> sites = sites_at(std::vector<openvdb::Vec3d>(1000, {0.52, 0.0, 2.0}));  // off the voxel centres
        EXPECT_EQ(hidden_count(sites, kind), 999u);
        EXPECT_EQ(labels_in_sphere(sites, kind), (std::set<std::int32_t>{1}));
        sites[700].weight_mm = kind == TessellationKind::multiplicative ? 0.9f : 1.1f;
        EXPECT_EQ(hidden_count(sites, kind), 999u);
        EXPECT_EQ(find_hidden_sites(sites, kind)[700], 0);
        EXPECT_EQ(labels_in_sphere(sites, kind), (std::set<std::int32_t>{701}));
    }
}

/// A million sites of which a part lies in the shape, four to a voxel there: nearly every voxel has an owner of its own. Strong
/// weights hide almost all sites in about the same time.
TEST(ExtremeCounts, AMillionSites) {
    const auto shape = shape_of(ShapeKind::box, {2.4, 2.4, 2.4});
    const auto level_set = shape->level_set(0.1);
    std::vector<Site> sites = random_sites({openvdb::Vec3d(-3.2, -3.2, -2.0), openvdb::Vec3d(3.2, 3.2, 4.4)}, 1'000'000, 0.01, 3);
    const std::vector<char> hidden = find_hidden_sites(sites);
    std::vector<std::int32_t> labels = one_label_each(sites);
    for (std::size_t n = 0; n < sites.size(); ++n)
        if (hidden[n] != 0) labels[n] = 0;
    const auto grid = label_voxels(sites, labels, *level_set);
    EXPECT_EQ(grid->activeVoxelCount(), 23u * 23u * 23u);
    std::set<std::int32_t> seen;
    for (auto value = grid->cbeginValueOn(); value; ++value) seen.insert(*value);
    EXPECT_GT(seen.size(), 11'000u);
    for (std::uint64_t n = 0; n < 30; ++n) {
        const openvdb::Coord voxel =
            openvdb::Coord::round(random_point({openvdb::Vec3d(-11.0, -11.0, 1.0), openvdb::Vec3d(11.0, 11.0, 23.0)}, 8, n));
        ASSERT_EQ(grid->tree().getValue(voxel),
                  testing_tools::searched_owner(voxel.asVec3d() * 0.1, sites, labels, TessellationKind::additive));
    }

    // Weights a hundred times the spacing, at random, then growing evenly by half a millimetre per millimetre, which
    // hides nobody.
    for (Site& site : sites) site.weight_mm *= 1000.0f;
    const std::vector<char> mostly_hidden = find_hidden_sites(sites);
    EXPECT_GT(std::count(mostly_hidden.begin(), mostly_hidden.end(), 1), 900'000);
    EXPECT_LT(std::count(mostly_hidden.begin(), mostly_hidden.end(), 1), 1'000'000);
    for (Site& site : sites) site.weight_mm = float(0.5 * site.position_mm.x());
    const std::vector<char> none_hidden = find_hidden_sites(sites);
    EXPECT_EQ(std::count(none_hidden.begin(), none_hidden.end(), 1), 0);
}

/// Of a shape smaller than its voxels, the voxels whose centres it happens to hold are labelled.
TEST(ExtremeSizes, AShapeSmallerThanAVoxel) {
    const auto level_set = shape_of(ShapeKind::sphere, {1.0, 1.0, 1.0})->level_set(0.5);
    const std::vector<Site> sites = sites_at({{0.1, 0.0, 0.5}, {-0.1, 0.0, 0.5}});
    const auto grid = label_voxels(sites, {1, 2}, *level_set);
    EXPECT_EQ(grid->activeVoxelCount(), 1u);
    EXPECT_EQ(grid->tree().getValue({0, 0, 1}), 1);
    const auto missed = label_voxels(sites, {1, 2}, *shape_of(ShapeKind::sphere, {1.0, 1.0, 1.0})->level_set(3.0));
    EXPECT_EQ(missed->activeVoxelCount(), 0u);
}

/// From a micrometre to a kilometre the labels are those of a full search.
TEST(ExtremeSizes, LabelsAreExactAtAnyScale) {
    for (const double size_mm : {0.001, 1.0, 1.0e6})
        for (const TessellationKind kind : metrics) {
            const auto shape = shape_of(ShapeKind::ellipsoid, {size_mm, 0.8 * size_mm, 0.6 * size_mm});
            const auto level_set = shape->level_set(size_mm / 40.0);
            std::vector<Site> sites = random_sites(shape->bounds_mm(), 50, 0.05 * size_mm, 5);
            if (kind == TessellationKind::multiplicative)
                for (Site& site : sites) site.weight_mm = float(std::exp(double(site.weight_mm) / size_mm));
            const std::vector<std::int32_t> labels = one_label_each(sites);
            const Tessellation tessellation{kind, {0.02 * size_mm, 0.2 * size_mm, 2}, 1};
            expect_searched_labels(*label_voxels(sites, labels, *level_set, tessellation), *level_set, sites, labels,
                                   tessellation);
        }
}

}  // namespace
}  // namespace opal
