// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stability_rows.h"

/// Where finding the grains along rays degrades.
namespace opal {

enum class WalkKind { cells, sphere_tracing, hyperboloid };
const char* name_of(WalkKind kind);

/// Share of the length of random rays that a walk puts into the wrong grain: 300 sites in a cube of 20 mm, weights up to
/// `spread_mm` apart, against the oracle. `offset_mm`: the cube's distance from the origin of coordinates, along x.
Estimate wrong_length(WalkKind kind, double spread_mm, double offset_mm, int rays);

/// A ray that crosses the flat boundary of two cells at an angle.
struct GrazingError {
    Estimate along_mm;   ///< error of the crossing's distance along the ray
    Estimate across_mm;  ///< that, times the sine of the angle: how deep in the wrong cell
    double us_per_ray = 0.0;
};
GrazingError grazing_error(WalkKind kind, double angle_rad, int rays);

/// Voxels against cells.
struct VoxelError {
    int resolution = 0;
    Estimate wrong;  ///< share of the rays' length in the wrong grain
};
/// Grains of one site each, as large as balls of `grain_mm`; voxels of 20 mm / resolution. A ball of four grains across, at least
/// 4 mm, stands for a gem of 20 mm. Cells, which are exact to rounding, tell the right grains.
std::vector<VoxelError> voxel_errors(double grain_mm, const std::vector<int>& resolutions, int rays);

/// Where an opal lies.
enum class Place { whole_scene_moved, moved_in_its_file };
/// A white-scattering, diffracting ball of 6 mm in a furnace.
struct FarRender {
    Estimate missing;  ///< of the light, which should be 1
    Estimate lost;     ///< share of the paths that left through a gap of the surface
    std::vector<std::string> notices;
};
FarRender far_render(Place place, double offset_mm, int samples);

void add_weight_rows(bool quick, StabilityRows& rows);
void add_far_rows(bool quick, StabilityRows& rows);
void add_grazing_rows(bool quick, StabilityRows& rows);
void add_voxel_rows(bool quick, StabilityRows& rows);

}  // namespace opal
