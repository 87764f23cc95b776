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

/// Beyond this distance along a ray no grain begins.
OPAL_HD inline real grains_end_mm(const GrainsView& grains, Vec3 origin, Vec3 direction) {
    if (grains.method == GrainMethod::voxels) {
        const nanovdb::CoordBBox box = grains.voxels.grid->indexBBox();
        const real mm = 1.0f / grains.voxels.voxels_per_mm;
        const Vec3 low{real(box.min()[0]) - 0.5f, real(box.min()[1]) - 0.5f, real(box.min()[2]) - 0.5f};
        const Vec3 high{real(box.max()[0]) + 0.5f, real(box.max()[1]) + 0.5f, real(box.max()[2]) + 0.5f};
        return way_out_mm(mm * (low - grains.voxels.index_of_origin), mm * (high - grains.voxels.index_of_origin), origin,
                          direction);
    }
    const CellField& cells = grains.cells;
    const real mm = 1.0f / cells.boxes_per_mm;
    const Vec3 size{real(cells.boxes[0]), real(cells.boxes[1]), real(cells.boxes[2])};
    return way_out_mm(cells.grid_origin, cells.grid_origin + mm * size, origin, direction);
}

/// The grains along one ray, by the method of the opal.
class GrainPath {
  public:
    /// As CellWalk; voxels have no cells.
    OPAL_HD GrainPath(const GrainsView& grains, Vec3 origin, Vec3 direction, int cell = -1)
        : method_(grains.method), end_mm_(grains_end_mm(grains, origin, direction)) {
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

    /// As theirs. A ray that has missed its way out of the body is not followed among grains that are not there: their walks know
    /// places only as well as those in the body ask for, and in voxels there is no end to the way.
    OPAL_HD int next_grain(int current, real& distance, real end) {
        const int grain = next_grain_within(current, distance, min_of(end, end_mm_));
        if (grain == 0) distance = end;
        return grain;
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
    OPAL_HD int next_grain_within(int current, real& distance, real end) {
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

    GrainMethod method_;
    real end_mm_;
    union {
        GrainWalk voxels_;
        CellWalk cells_;
        SphereTracingWalk sphere_tracing_;
        HyperboloidWalk hyperboloid_;
    };
};

}  // namespace opal
