// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <new>

#include "renderer/core/cell_walk.h"
#include "renderer/core/grain_walk.h"
#include "renderer/core/hyperboloid_walk.h"
#include "renderer/core/sphere_tracing_walk.h"

namespace opal {

/// How the grains that a ray meets are found.
enum class GrainMethod { voxels, cells, sphere_tracing, hyperboloid };

/// The grains of an opal, in the form that its method reads.
struct GrainsView {
    GrainMethod method = GrainMethod::voxels;
    GrainField voxels;
    CellField cells;
};

/// A ball of this radius about a place (object mm) in `grain`, and in `cell` where grains are cells, lies in the grain.
OPAL_HD inline real grain_clearance_mm(const GrainsView& grains, Vec3 position, int grain, int cell) {
    if (grains.method == GrainMethod::voxels) return grain_clearance_mm(grains.voxels, position, grain);
    if (cell < 0 || grains.cells.grain[cell] != grain) return 0.0f;
    return cell_clearance_mm(grains.cells, position, cell);
}

/// The grains along one ray, by the method of the opal.
class GrainPath {
  public:
    /// As CellWalk; voxels have no cells.
    OPAL_HD GrainPath(const GrainsView& grains, Vec3 origin, Vec3 direction, int cell = -1) : method_(grains.method) {
        switch (method_) {
            case GrainMethod::voxels:
                new (&voxels_) GrainWalk(grains.voxels, origin, direction);
                break;
            case GrainMethod::cells:
                new (&cells_) CellWalk(grains.cells, origin, direction, cell);
                break;
            case GrainMethod::sphere_tracing:
                new (&sphere_tracing_) SphereTracingWalk(grains.cells, origin, direction, cell);
                break;
            case GrainMethod::hyperboloid:
                new (&hyperboloid_) HyperboloidWalk(grains.cells, origin, direction, cell);
                break;
        }
    }
    GrainPath(const GrainPath&) = delete;
    GrainPath& operator=(const GrainPath&) = delete;

    OPAL_HD int next_grain(int current, real& distance, real end) {
        switch (method_) {
            case GrainMethod::cells:
                return cells_.next_grain(current, distance, end);
            case GrainMethod::sphere_tracing:
                return sphere_tracing_.next_grain(current, distance, end);
            case GrainMethod::hyperboloid:
                return hyperboloid_.next_grain(current, distance, end);
            default:
                return voxels_.next_grain(current, distance, end);
        }
    }

    /// Where the path stands; -1 with voxels.
    OPAL_HD int cell() const {
        switch (method_) {
            case GrainMethod::cells:
                return cells_.cell();
            case GrainMethod::sphere_tracing:
                return sphere_tracing_.cell();
            case GrainMethod::hyperboloid:
                return hyperboloid_.cell();
            default:
                return -1;
        }
    }

  private:
    GrainMethod method_;
    union {
        GrainWalk voxels_;
        CellWalk cells_;
        SphereTracingWalk sphere_tracing_;
        HyperboloidWalk hyperboloid_;
    };
};

}  // namespace opal
