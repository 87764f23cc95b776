// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cstddef>
#include <functional>

#include "modeler/shape.h"

namespace opal {

/// How far the surface may be off at a place of it (mm); infinite where nothing is asked of it. Called from several threads.
using AcceptedSurfaceError = std::function<double(const openvdb::Vec3d& point_mm)>;

/// How coarse a surface's voxels may be, and how far off that leaves it.
struct SurfaceNeeds {
    double voxel_size_mm = 0.0;
    double error_mm = 0.0;             ///< the largest found where something is asked of the surface; 0 where nothing is
    double error_over_accepted = 0.0;  ///< at the place where it is largest; above 1 only where the finest voxels are too coarse
    std::size_t places = 0;            ///< of the surface that were looked at
};

/// The coarsest voxels between `finest_mm` and `coarsest_mm` (in steps of a factor of 1.19) whose level set follows the shape's
/// surface within `accepted_mm`; the finest where none does. The error at a place of the surface is an estimate from ten values
/// of the distance function: how far the surface strays from its tangent a voxel aside, in eight directions (for a radius of
/// curvature r: h^2 / 2r, half of which is the facets' error, half that of interpolation between voxels), and by how much the
/// distance 1.5 voxels in and out is not what it would be near a flat surface (thin walls, gaps, the far side of an edge).
/// Places: some thousand, random, more of them on edges and corners, the same for the same shape; what is smaller than their
/// distance may be missed. Throws Interrupted on Ctrl-C.
SurfaceNeeds coarsest_surface_voxels(const Shape& shape, const AcceptedSurfaceError& accepted_mm, double finest_mm,
                                     double coarsest_mm);

}  // namespace opal
