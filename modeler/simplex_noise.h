// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>

#include "modeler/gradient_noise.h"

namespace opal {

/// Smooth random field in [-1, 1], a pure function of its arguments; features are about one unit long. Simplex noise (K. Perlin,
/// "Noise hardware", SIGGRAPH 2001 course notes; S. Gustavson, "Simplex noise demystified", 2005): space skewed along (1, 1, 1)
/// falls into six tetrahedra per cube, and each of a tetrahedron's corners c adds (1/2 - |x - c|^2)^4 g_c.(x - c). The radius
/// sqrt(1/2) lets every corner fade out before the tetrahedra that touch it end, so the field is three times differentiable (the
/// 0.6 of some implementations leaves jumps). Gradients g_c are uniform on the sphere, so no axis is preferred by them.
double simplex_noise(const openvdb::Vec3d& position, const NoiseSource& source, std::uint32_t octave);

/// Fractional Brownian motion of simplex noise, in [-1, 1].
double fractal_simplex_noise(const openvdb::Vec3d& position, const NoiseSource& source, int octaves);

}  // namespace opal
