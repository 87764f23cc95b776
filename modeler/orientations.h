// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/math/Quat.h>

#include <cstdint>
#include <filesystem>
#include <vector>

#include "formats/random.h"
#include "formats/recipe.h"
#include "modeler/neighbour_graph.h"
#include "modeler/sintering.h"

namespace opal {

/// Lattice -> world, (x, y, z, w), of unit length.
using Orientation = openvdb::math::Quat<float>;

/// Orientation `index` of a fibre texture, a pure function of (seed, stream, index): the lattice direction lies near the axis,
/// and the crystal is turned about the axis by a uniform angle.
///
/// The direction follows R. A. Fisher's distribution on the sphere ("Dispersion on a sphere", Proc. R. Soc. A 217, 1953), whose
/// density is proportional to exp(kappa cos tilt) per solid angle, with kappa = 2 / spread^2 (spread in radians). Its mean is
/// E[cos tilt] = coth kappa - 1 / kappa, and for narrow textures the root mean square of the tilt is the spread; 0 puts the
/// direction exactly on the axis. Inverse of the distribution of the cosine: W. Jakob, "Numerically stable sampling of the von
/// Mises-Fisher distribution on S2", 2012.
Orientation fibre_orientation(const OrientationRecipe& fibre, std::uint64_t seed, RandomStream stream, std::uint64_t index);

/// One orientation per site, drawn before sites grow together: uniform or fibre, as the recipe says.
std::vector<Orientation> site_orientations(const OrientationRecipe& recipe, std::size_t num_sites, std::uint64_t seed);

/// One orientation per grain: drawn (uniform: `random_orientation`; fibre), or read from the table.
std::vector<Orientation> grain_orientations(const OrientationRecipe& recipe, std::int32_t num_grains, std::uint64_t seed);

/// The grains' orientations where the sites had theirs before: each grain has its lowest site's. A site's number says nothing
/// about its place, so this is a fair draw among the members: the distribution of orientations stays what it was.
std::vector<Orientation> orientations_of_grains(const std::vector<Orientation>& of_sites, const Sintering& sintering);

/// Weights exp(-(theta / theta_0)^2) of the graph's bonds, theta the misorientation of their two sites' lattices: 1 between
/// aligned lattices, next to nothing across angles far above theta_0.
std::vector<double> misorientation_weights(const NeighbourGraph& graph, const std::vector<Orientation>& of_sites,
                                           double theta_0_rad);

/// Reads grains' orientations from a .csv with lines grain,x,y,z,w (a line of names may come first; # begins a comment), lattice
/// -> world. Throws InputError at file:line where a line is not that, a quaternion's length is off 1 by more than 1e-3, or a
/// grain is given twice or is none of 1 to `num_grains`; and where grains are missing.
std::vector<Orientation> read_orientation_table(const std::filesystem::path& file, std::int32_t num_grains);

}  // namespace opal
