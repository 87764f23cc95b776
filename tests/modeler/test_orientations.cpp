// SPDX-License-Identifier: Apache-2.0
#include "modeler/orientations.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "../renderer/chi_square.h"
#include "formats/units.h"
#include "modeler/misorientation.h"
#include "modeler_test_tools.h"

namespace opal {
namespace {

using Quatd = openvdb::math::Quat<double>;
using testing_tools::input_error_of;
using testing_tools::write_test_file;

/// The 24 rotations of a cube: all unit quaternions whose components are those of (1,0,0,0), (1,1,0,0)/sqrt 2 or (1,1,1,1)/2 in
/// any order and with any signs, one of each +-pair.
std::vector<Quatd> cube_rotations() {
    std::vector<Quatd> rotations;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                for (int w = -1; w <= 1; ++w) {
                    const int count = std::abs(x) + std::abs(y) + std::abs(z) + std::abs(w);
                    if (count == 0 || count == 3) continue;
                    const int first = x != 0 ? x : y != 0 ? y : z != 0 ? z : w;
                    if (first < 0) continue;
                    rotations.push_back(Quatd(x, y, z, w) * (1.0 / std::sqrt(double(count))));
                }
    return rotations;
}

Quatd in_double(const Orientation& q) {
    return Quatd(q.x(), q.y(), q.z(), q.w());
}

Orientation in_float(const Quatd& q) {
    return Orientation(float(q.x()), float(q.y()), float(q.z()), float(q.w()));
}

/// q v q*, written out.
openvdb::Vec3d rotated(const Orientation& q, const openvdb::Vec3d& v) {
    const openvdb::Vec3d u(q.x(), q.y(), q.z());
    return v + 2.0 * double(q.w()) * u.cross(v) + 2.0 * u.cross(u.cross(v));
}

TEST(Misorientation, EqualsASearchThroughAllRotationsOfACube) {
    const std::vector<Quatd> cube = cube_rotations();
    ASSERT_EQ(cube.size(), 24u);
    double largest = 0.0;
    for (std::uint64_t n = 0; n < 20'000; ++n) {
        const Orientation q1 = random_orientation(1, false, 2 * n), q2 = random_orientation(1, false, 2 * n + 1);
        double cosine = 0.0;
        for (const Quatd& s : cube)
            cosine = std::max(cosine, std::abs((in_double(q1).unit().conjugate() * in_double(q2).unit() * s).w()));
        const double angle_rad = misorientation_angle_rad(q1, q2);
        ASSERT_NEAR(angle_rad, 2.0 * std::acos(std::min(1.0, cosine)), 1e-7);
        ASSERT_NEAR(angle_rad, misorientation_angle_rad(q2, q1), 1e-12);
        largest = std::max(largest, angle_rad);
    }
    EXPECT_LE(largest, max_misorientation_rad + 1e-6);
    EXPECT_NEAR(units::deg_from_rad(max_misorientation_rad), 62.7994, 1e-4);
}

TEST(Misorientation, OfEquivalentAndOfSlightlyTurnedLattices) {
    for (std::uint64_t n = 0; n < 100; ++n) {
        const Orientation q = random_orientation(2, false, n);
        for (const Quatd& s : cube_rotations()) {
            EXPECT_NEAR(misorientation_angle_rad(q, in_float(in_double(q) * s)), 0.0, 1e-6);
            const double angle_rad = 1e-3;
            const Quatd turn(std::sin(0.5 * angle_rad), 0.0, 0.0, std::cos(0.5 * angle_rad));
            EXPECT_NEAR(misorientation_angle_rad(q, in_float(turn * in_double(q) * s)), angle_rad, 1e-6);
        }
    }
}

TEST(Mackenzie, IsADensityWithTheKnownMean) {
    EXPECT_NEAR(mackenzie_distribution(max_misorientation_rad), 1.0, 1e-6);
    EXPECT_EQ(mackenzie_distribution(0.0), 0.0);
    EXPECT_EQ(mackenzie_density(max_misorientation_rad + 1e-9), 0.0);
    // Continuous at its bends: 45, 60 and 60.72 degrees.
    for (const double bend_rad : {0.25 * units::pi, units::pi / 3.0, 2.0 * std::atan(2.0 - std::sqrt(2.0))})
        EXPECT_NEAR(mackenzie_density(bend_rad - 1e-9), mackenzie_density(bend_rad + 1e-9), 1e-4);
    // Mean 40.74 degrees, and 1 - (24 / pi) (pi / 4 - sin(pi / 4)) = 40.19 % of the pairs above 45 degrees (Mackenzie 1958).
    double mean_rad = 0.0;
    const int steps = 20'000;
    for (int n = 0; n < steps; ++n) {
        const double angle_rad = max_misorientation_rad * (n + 0.5) / steps;
        mean_rad += angle_rad * mackenzie_density(angle_rad) * max_misorientation_rad / steps;
    }
    EXPECT_NEAR(units::deg_from_rad(mean_rad), 40.736, 1e-3);
    EXPECT_NEAR(mackenzie_distribution(0.25 * units::pi), 24.0 / units::pi * (0.25 * units::pi - std::sqrt(0.5)), 1e-9);
}

/// Pearson's chi-square of the misorientations of 100,000 disjoint, so independent, pairs against Mackenzie's distribution in
/// 1-degree bins; those that expect fewer than 50 are joined to the next.
double mackenzie_chi_square(const std::function<Orientation(std::uint64_t)>& orientation, int& degrees_of_freedom) {
    constexpr int pairs = 100'000;
    std::vector<double> observed(64, 0.0);
    for (std::uint64_t n = 0; n < pairs; ++n) {
        const double angle_rad = misorientation_angle_rad(orientation(2 * n + 1), orientation(2 * n + 2));
        observed[std::size_t(units::deg_from_rad(angle_rad))] += 1.0;
    }
    double statistic = 0.0, expected = 0.0, seen = 0.0, below = 0.0;
    degrees_of_freedom = -1;
    for (std::size_t bin = 0; bin < 64; ++bin) {
        const double up_to = mackenzie_distribution(units::rad_from_deg(double(bin) + 1.0));
        expected += pairs * (up_to - below);
        seen += observed[bin];
        below = up_to;
        if (expected < 50.0 && bin < 63) continue;
        if (expected < 1.0e-3) {  // beyond the largest angle
            EXPECT_EQ(seen, 0.0);
            break;
        }
        statistic += (seen - expected) * (seen - expected) / expected;
        ++degrees_of_freedom;
        expected = seen = 0.0;
    }
    return statistic;
}

TEST(Mackenzie, RandomOrientationsPassAndSlightlyWrongOnesDoNot) {
    // alpha = 1e-6: normal quantile 4.75.
    int freedom = 0;
    const double right = mackenzie_chi_square([](std::uint64_t n) { return random_orientation(7, false, n); }, freedom);
    EXPECT_LT(right, chi_square_limit(freedom)) << freedom;
    EXPECT_GT(freedom, 40);
    // Euler angles drawn uniformly, a common mistake: the polar angle's cosine should have been.
    const auto euler = [](std::uint64_t n) {
        const RandomBlock block = random_block(7, RandomStream::bench, n, 0), more = random_block(7, RandomStream::bench, n, 1);
        const double a = units::pi * uniform_double(block.value[0], block.value[1]);
        const double b = 0.5 * units::pi * uniform_double(block.value[2], block.value[3]);
        const double c = units::pi * uniform_double(more.value[0], more.value[1]);
        return in_float(Quatd(0, 0, std::sin(a), std::cos(a)) * Quatd(std::sin(b), 0, 0, std::cos(b)) *
                        Quatd(0, 0, std::sin(c), std::cos(c)));
    };
    EXPECT_GT(mackenzie_chi_square(euler, freedom), chi_square_limit(freedom));
    // Three in a hundred grains share one orientation's neighbourhood: a weak texture.
    const auto textured = [](std::uint64_t n) {
        const Orientation q = random_orientation(7, false, n);
        return n % 100 < 3 ? in_float(Quatd(0.1 * q.x(), 0.1 * q.y(), 0.1 * q.z(), 1.0).unit()) : q;
    };
    EXPECT_GT(mackenzie_chi_square(textured, freedom), chi_square_limit(freedom));
}

OrientationRecipe fibre(double spread_deg) {
    OrientationRecipe recipe;
    recipe.kind = OrientationKind::fibre;
    recipe.axis = {1.0, -2.0, 0.5};
    recipe.lattice = {1.0, 1.0, 1.0};
    recipe.spread_deg = spread_deg;
    return recipe;
}

TEST(FibreTexture, WithoutSpreadLiesOnTheAxis) {
    const openvdb::Vec3d axis = openvdb::Vec3d(1.0, -2.0, 0.5).unit(), lattice = openvdb::Vec3d(1.0).unit();
    for (const Orientation& q : grain_orientations(fibre(0.0), 200, 3)) {
        EXPECT_NEAR(in_double(q).dot(in_double(q)), 1.0, 1e-6);
        EXPECT_LT((rotated(q, lattice) - axis).length(), 1e-6);
    }
    // Opposite directions have no shortest arc of their own.
    OrientationRecipe opposite = fibre(0.0);
    opposite.axis = {0.0, 0.0, -2.0};
    opposite.lattice = {0.0, 0.0, 1.0};
    for (const Orientation& q : grain_orientations(opposite, 20, 3))
        EXPECT_LT((rotated(q, {0, 0, 1}) - openvdb::Vec3d(0, 0, -1)).length(), 1e-6);
}

TEST(FibreTexture, TiltsAsStatedAndSpinsUniformly) {
    const openvdb::Vec3d axis = openvdb::Vec3d(1.0, -2.0, 0.5).unit(), lattice = openvdb::Vec3d(1.0).unit();
    const openvdb::Vec3d side = axis.cross(openvdb::Vec3d(1, 0, 0)).unit(), other = axis.cross(side);
    constexpr int count = 40'000;
    for (const double spread_deg : {2.0, 10.0, 45.0, 180.0}) {
        const double kappa = 2.0 / std::pow(units::rad_from_deg(spread_deg), 2.0);
        const double mean_cosine = 1.0 / std::tanh(kappa) - 1.0 / kappa;
        double sum = 0.0, squares = 0.0, square_tilt = 0.0, azimuth[2] = {}, spin[2] = {};
        for (const Orientation& q : grain_orientations(fibre(spread_deg), count, 8)) {
            const openvdb::Vec3d direction = rotated(q, lattice);
            const double loss = 1.0 - direction.dot(axis);
            sum += loss;
            squares += loss * loss;
            square_tilt += std::pow(std::atan2(direction.cross(axis).length(), direction.dot(axis)), 2.0);
            const double phi = std::atan2(direction.dot(other), direction.dot(side));
            azimuth[0] += std::cos(phi);
            azimuth[1] += std::sin(phi);
            // A lattice direction across the fibre shows the spin.
            const openvdb::Vec3d across = rotated(q, openvdb::Vec3d(1, -1, 0).unit());
            const double turn = std::atan2(across.dot(other), across.dot(side));
            spin[0] += std::cos(turn);
            spin[1] += std::sin(turn);
        }
        const double mean = sum / count, error = std::sqrt((squares / count - mean * mean) / count);
        EXPECT_NEAR(mean, 1.0 - mean_cosine, 4.0 * error) << spread_deg;
        EXPECT_LT(4.0 * error, 0.03 * mean) << spread_deg;  // the test tells 3 % of the variance
        for (const double part : {azimuth[0], azimuth[1], spin[0], spin[1]})
            EXPECT_NEAR(part / count, 0.0, 4.0 * std::sqrt(0.5 / count));
        // E[tilt^2] = spread^2 (1 + spread^2 / 6 + ...), and tilt^2 scatters by its own mean: 4 x 0.25 % of the root, and 0.25 %.
        if (spread_deg <= 10.0) {
            EXPECT_NEAR(std::sqrt(square_tilt / count), units::rad_from_deg(spread_deg), 0.015 * units::rad_from_deg(spread_deg));
        }
    }
}

TEST(Orientations, UniformOnesAreThoseOfTheAsset) {
    const std::vector<Orientation> grains = grain_orientations({}, 50, 12);
    for (std::size_t n = 0; n < grains.size(); ++n) EXPECT_EQ(grains[n], random_orientation(12, false, n + 1));
    EXPECT_NE(site_orientations({}, 1, 12)[0], grains[0]);
}

TEST(Orientations, AGrainHasItsLowestSitesOrientation) {
    const std::vector<Orientation> of_sites = site_orientations({}, 6, 4);
    Sintering sintering;
    sintering.grain_of_site = {1, 0, 2, 1, 3, 2};
    const std::vector<Orientation> of_grains = orientations_of_grains(of_sites, sintering);
    EXPECT_EQ(of_grains, (std::vector<Orientation>{of_sites[0], of_sites[2], of_sites[4]}));
}

TEST(Orientations, MisorientationWeightsFallWithTheAngle) {
    const std::vector<Orientation> of_sites = site_orientations({}, 40, 4);
    NeighbourGraph graph;
    for (std::int32_t n = 1; n < 40; ++n) graph.push_back({0, n});
    const std::vector<double> weights = misorientation_weights(graph, of_sites, 0.3);
    for (std::size_t n = 0; n < graph.size(); ++n) {
        const double angle_rad = misorientation_angle_rad(of_sites[0], of_sites[n + 1]);
        EXPECT_DOUBLE_EQ(weights[n], std::exp(-(angle_rad / 0.3) * (angle_rad / 0.3)));
    }
    EXPECT_EQ(misorientation_weights({{0, 1}}, {of_sites[0], of_sites[0]}, 0.3), std::vector<double>{1.0});
}

TEST(Orientations, SinteringByMisorientationKeepsBondsByTheLawOfTheRace) {
    // Over Mackenzie's density f, a bond is kept with probability int f(t) (1 - (1 - p)^exp(-(t / t0)^2)) dt. Two bonds'
    // misorientations are independent even where they share a site, so the number kept scatters binomially.
    std::vector<openvdb::Coord> cells;
    for (const openvdb::Coord& cell : openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(29))) cells.push_back(cell);
    const std::vector<char> hidden(cells.size(), 0);
    const NeighbourGraph graph = lattice_graph(cells, hidden);
    const double theta_0_rad = units::rad_from_deg(15.0);
    const std::vector<double> weights = misorientation_weights(graph, site_orientations({}, cells.size(), 9), theta_0_rad);
    for (const double p : {0.2, 0.9}) {
        double expected = 0.0;
        const int steps = 20'000;
        for (int n = 0; n < steps; ++n) {
            const double angle_rad = max_misorientation_rad * (n + 0.5) / steps;
            const double omega = std::exp(-std::pow(angle_rad / theta_0_rad, 2.0));
            expected += mackenzie_density(angle_rad) * (1.0 - std::pow(1.0 - p, omega)) * max_misorientation_rad / steps;
        }
        SinteringRecipe recipe;
        recipe.probability = p;
        const Sintering result = sinter(graph, hidden, recipe, 9, weights);
        const double bonds = double(graph.size());
        EXPECT_NEAR(double(result.num_kept_bonds) / bonds, expected, 4.0 * std::sqrt(expected * (1.0 - expected) / bonds)) << p;
    }
}

TEST(OrientationTable, ReadsGrainsInAnyOrder) {
    const std::string file =
        write_test_file("table.csv", "# from a measurement\ngrain,x,y,z,w\n2, 0,0,0,1\r\n\n3,0.6,0,0,0.8\n1,0,1,0,0\n");
    const std::vector<Orientation> q = read_orientation_table(file, 3);
    EXPECT_EQ(q[0], Orientation(0.0f, 1.0f, 0.0f, 0.0f));
    EXPECT_EQ(q[1], Orientation(0.0f, 0.0f, 0.0f, 1.0f));
    EXPECT_EQ(q[2], Orientation(0.6f, 0.0f, 0.0f, 0.8f));
    const std::string rounded = write_test_file("table.csv", "1,0.0009,0,0,1.0009\n");
    EXPECT_NEAR(read_orientation_table(rounded, 1)[0].w(), 1.0, 1e-6);
}

TEST(OrientationTable, NamesTheLineThatIsWrong) {
    const auto error_of = [](const std::string& text) {
        const std::string file = write_test_file("table.csv", text);
        return input_error_of([&] { read_orientation_table(file, 2); });
    };
    EXPECT_NE(error_of("1,0,0,0,1\n2,0,0,0,1.01\n").find("table.csv:2: the quaternion's length is 1.01; allowed: 1 within 0.001"),
              std::string::npos);
    EXPECT_NE(error_of("1,0,0,0,1\n3,0,0,0,1\n").find("table.csv:2: grain 3 is not there; this opal's grains are 1 to 2"),
              std::string::npos);
    EXPECT_NE(error_of("1,0,0,0,1\n1,0,0,0,1\n").find("table.csv:2: grain 1 is given a second time"), std::string::npos);
    EXPECT_NE(error_of("1.5,0,0,0,1\n").find("table.csv:1: grain 1.5 is not there"), std::string::npos);
    EXPECT_NE(error_of("1,0,0,0,1\n").find("table.csv: no orientation of grain 2"), std::string::npos);
    for (const char* line : {"2,0,0,1", "2,0,0,0,1,5", "2,0,0,zero,1", "2;0;0;0;1", "2,0,0,nan,1"})
        EXPECT_NE(error_of("1,0,0,0,1\n" + std::string(line) + "\n").find("table.csv:2: expected 'grain,x,y,z,w'"),
                  std::string::npos)
            << line;
    EXPECT_NE(input_error_of([] { read_orientation_table("/nowhere/table.csv", 2); }).find("/nowhere/table.csv: no such file"),
              std::string::npos);
}

}  // namespace
}  // namespace opal
