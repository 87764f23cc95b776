// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/orientations.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "formats/opal_asset.h"
#include "formats/units.h"
#include "modeler/misorientation.h"

namespace opal {
namespace {

using Quatd = openvdb::math::Quat<double>;

openvdb::Vec3d unit(const std::array<double, 3>& v) {
    return openvdb::Vec3d(v[0], v[1], v[2]).unit();
}

openvdb::Vec3d any_perpendicular(const openvdb::Vec3d& v) {
    const openvdb::Vec3d other = std::abs(v.x()) < 0.6 ? openvdb::Vec3d(1, 0, 0) : openvdb::Vec3d(0, 1, 0);
    return v.cross(other).unit();
}

Quatd rotation(const openvdb::Vec3d& axis, double half_sine, double half_cosine) {
    const openvdb::Vec3d v = axis * half_sine;
    return Quatd(v.x(), v.y(), v.z(), half_cosine);
}

/// The shortest rotation that carries one unit vector to the other.
Quatd shortest_arc(const openvdb::Vec3d& from, const openvdb::Vec3d& to) {
    const double half_cosine = std::sqrt(std::max(0.0, 0.5 * (1.0 + from.dot(to))));
    if (half_cosine < 1.0e-6) return rotation(any_perpendicular(from), 1.0, 0.0);
    const openvdb::Vec3d v = from.cross(to) / (2.0 * half_cosine);
    return Quatd(v.x(), v.y(), v.z(), half_cosine);
}

/// sin^2(tilt / 2) of Fisher's distribution, for a uniform u in [0, 1).
double sample_half_tilt(double u, double spread_rad) {
    if (spread_rad == 0.0) return 0.0;
    const double kappa = 2.0 / (spread_rad * spread_rad);
    return std::clamp(-std::log1p(u * std::expm1(-2.0 * kappa)) / (2.0 * kappa), 0.0, 1.0);
}

Orientation site_orientation(const OrientationRecipe& recipe, std::uint64_t seed, std::uint64_t site) {
    return recipe.kind == OrientationKind::fibre ? fibre_orientation(recipe, seed, RandomStream::site_orientations, site)
                                                 : uniform_rotation(seed, RandomStream::site_orientations, site);
}

}  // namespace

Orientation fibre_orientation(const OrientationRecipe& fibre, std::uint64_t seed, RandomStream stream, std::uint64_t index) {
    const RandomBlock first = random_block(seed, stream, index, 0), second = random_block(seed, stream, index, 1);
    const double half_spin_rad = units::pi * uniform_double(first.value[2], first.value[3]);
    const double azimuth_rad = 2.0 * units::pi * uniform_double(second.value[0], second.value[1]);
    const double half_tilt =
        sample_half_tilt(uniform_double(first.value[0], first.value[1]), units::rad_from_deg(fibre.spread_deg));

    const openvdb::Vec3d axis = unit(fibre.axis), side = any_perpendicular(axis);
    const openvdb::Vec3d tilt_axis = std::cos(azimuth_rad) * side + std::sin(azimuth_rad) * axis.cross(side);
    const Quatd q = rotation(tilt_axis, std::sqrt(half_tilt), std::sqrt(1.0 - half_tilt)) *
                    rotation(axis, std::sin(half_spin_rad), std::cos(half_spin_rad)) * shortest_arc(unit(fibre.lattice), axis);
    return Orientation(float(q.x()), float(q.y()), float(q.z()), float(q.w()));
}

std::vector<Orientation> site_orientations(const OrientationRecipe& recipe, std::size_t num_sites, std::uint64_t seed) {
    std::vector<Orientation> orientations(num_sites);
    tbb::parallel_for(std::size_t(0), num_sites, [&](std::size_t n) { orientations[n] = site_orientation(recipe, seed, n + 1); });
    return orientations;
}

std::vector<Orientation> grain_orientations(const OrientationRecipe& recipe, std::int32_t num_grains, std::uint64_t seed) {
    if (recipe.kind == OrientationKind::table) return read_orientation_table(recipe.file, num_grains);
    std::vector<Orientation> orientations(static_cast<std::size_t>(num_grains));
    tbb::parallel_for(std::size_t(0), orientations.size(), [&](std::size_t n) {
        orientations[n] = recipe.kind == OrientationKind::fibre
                              ? fibre_orientation(recipe, seed, RandomStream::grain_orientations, n + 1)
                              : random_orientation(seed, false, n + 1);
    });
    return orientations;
}

std::vector<Orientation> orientations_of_grains(const std::vector<Orientation>& of_sites, const Sintering& sintering) {
    std::vector<Orientation> orientations;
    for (std::size_t site = 0; site < of_sites.size(); ++site)
        if (sintering.grain_of_site[site] == std::ssize(orientations) + 1) orientations.push_back(of_sites[site]);
    return orientations;
}

std::vector<double> misorientation_weights(const NeighbourGraph& graph, const std::vector<Orientation>& of_sites,
                                           double theta_0_rad) {
    std::vector<double> weights(graph.size());
    tbb::parallel_for(std::size_t(0), graph.size(), [&](std::size_t n) {
        const double theta_rad = misorientation_angle_rad(of_sites[static_cast<std::size_t>(graph[n].first)],
                                                          of_sites[static_cast<std::size_t>(graph[n].second)]);
        weights[n] = std::exp(-(theta_rad / theta_0_rad) * (theta_rad / theta_0_rad));
    });
    return weights;
}

}  // namespace opal
