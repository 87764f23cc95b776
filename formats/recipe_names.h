// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "formats/recipe.h"

/// How recipe.toml spells the members of the recipe's enumerations, in their order.
namespace opal::recipe_names {

using Names = std::vector<std::string>;

inline const Names shapes = {"ellipsoid", "sphere", "box", "cabochon", "mesh", "bezier"};
inline const Names patches = {"cabochon", "teapot"};
inline const Names sites = {"poisson-disk", "jittered-lattice", "file"};
inline const Names regions = {"shape", "bounds"};
inline const Names tessellations = {"additive", "voronoi", "multiplicative", "manhattan"};
inline const Names weights = {"none", "perlin", "simplex", "linear", "radial", "distance", "grid", "csv"};
inline const Names graphs = {"apollonius", "delaunay", "lattice"};
inline const Names preferences = {"none", "misorientation", "area"};
inline const Names orientations = {"uniform", "fibre", "table"};
inline const Names mie_phases = {"henyey-greenstein", "draine", "schlick", "lorenz-mie"};
inline const Names mie_particles = {"vacancy", "sphere"};
inline const Names fields = {"constant", "noise", "layers", "grains", "grid"};
inline const Names grids = {"grain_id", "shape", "weight", "fields", "sites"};

template <typename Enum>
Enum value(const Names& names, const std::string& name) {
    return static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
}

template <typename Enum>
const std::string& name(const Names& names, Enum value) {
    return names[static_cast<std::size_t>(value)];
}

}  // namespace opal::recipe_names
