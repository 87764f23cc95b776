// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanovdb/NanoVDB.h>

#include "renderer/core/vec.h"

namespace opal {

using GrainGrid = nanovdb::NanoGrid<int32_t>;

/// Where the grains of an opal are: the labelled voxels and their placement in the object's own space.
struct GrainField {
    const GrainGrid* grid = nullptr;
    real voxels_per_mm = 1.0f;  ///< object space
    Vec3 index_of_origin;       ///< index coordinates of the object's origin; voxel centres are at integers
};

/// A ball about a place (object mm) that holds no grain but `grain`: half a voxel where the voxels that such a ball can touch are
/// all the grain's, else 0.
OPAL_HD inline real grain_clearance_mm(const GrainField& field, Vec3 position_mm, int grain) {
    // Voxels [i - 1/2, i + 1/2): a cube of edge one about the place touches those of the eight nearest centres.
    const Vec3 index = field.voxels_per_mm * position_mm + field.index_of_origin;
    const nanovdb::Coord low(int(floor(index.x)), int(floor(index.y)), int(floor(index.z)));
    nanovdb::DefaultReadAccessor<int32_t> accessor(field.grid->tree().root());
    for (int k = 0; k < 8; ++k)
        if (accessor.getValue(low + nanovdb::Coord(k >> 2, (k >> 1) & 1, k & 1)) != grain) return 0.0f;
    return 0.49f / field.voxels_per_mm;
}

/// Hierarchical DDA: walks a ray through the tree of grain_id, one constant tile, empty node or voxel at a time. Each step leaves
/// the box it is in through the exact face that the ray meets first, so no box is skipped and none is visited twice.
class GrainWalk {
  public:
    /// `origin`, `direction` in object space (mm); distances below are along the ray, mm of object space.
    OPAL_HD GrainWalk(const GrainField& field, Vec3 origin, Vec3 direction)
        : accessor_(field.grid->tree().root()), direction_(field.voxels_per_mm * direction) {
        // A voxel with centre i covers [i - 1/2, i + 1/2): shifted by half so that floor finds it.
        origin_ = field.voxels_per_mm * origin + field.index_of_origin + Vec3{0.5f, 0.5f, 0.5f};
        inverse_ = {1.0f / direction_.x, 1.0f / direction_.y, 1.0f / direction_.z};
        voxel_ = {int(floor(origin_.x)), int(floor(origin_.y)), int(floor(origin_.z))};
    }

    /// Goes on from `distance` to where a grain other than `current` begins, and returns it with `distance` set there. Unlabelled
    /// voxels (0: those cut by the surface) belong to the grain before them. Returns 0 with `distance` = `end` if there is none;
    /// may be asked again with an end farther away.
    OPAL_HD int next_grain(int current, real& distance, real end) {
        while (true) {
            if (entered_ > 0.0f && entered_ >= end) {
                distance = end;
                return 0;
            }
            distance = max_of(distance, entered_);
            const int grain = accessor_.getValue(voxel_);
            if (grain != 0 && grain != current) return grain;
            leave_box(int(accessor_.getDim(voxel_, 0)), entered_);
        }
    }

  private:
    OPAL_HD static real exit_distance(real direction, real inverse, real origin, int low, int size) {
        if (direction == 0.0f) return 3.0e38f;
        return (real(direction > 0.0f ? low + size : low) - origin) * inverse;
    }

    OPAL_HD static int entered_index(real direction, int low, int size) { return direction > 0.0f ? low + size : low - 1; }

    OPAL_HD static int clamped_index(real position, int low, int size) {
        return min_of(max_of(int(floor(position)), low), low + size - 1);
    }

    OPAL_HD void leave_box(int size, real& distance) {
        const int low_x = voxel_[0] & ~(size - 1), low_y = voxel_[1] & ~(size - 1), low_z = voxel_[2] & ~(size - 1);
        const real exit_x = exit_distance(direction_.x, inverse_.x, origin_.x, low_x, size);
        const real exit_y = exit_distance(direction_.y, inverse_.y, origin_.y, low_y, size);
        const real exit_z = exit_distance(direction_.z, inverse_.z, origin_.z, low_z, size);
        const real exit = min_of(exit_x, min_of(exit_y, exit_z));
        distance = max_of(distance, exit);
        const Vec3 position = origin_ + distance * direction_;
        voxel_ = {
            exit_x == exit ? entered_index(direction_.x, low_x, size) : clamped_index(position.x, low_x, size),
            exit_x != exit && exit_y == exit ? entered_index(direction_.y, low_y, size) : clamped_index(position.y, low_y, size),
            exit_x != exit && exit_y != exit ? entered_index(direction_.z, low_z, size) : clamped_index(position.z, low_z, size)};
    }

    nanovdb::DefaultReadAccessor<int32_t> accessor_;
    Vec3 origin_, direction_, inverse_;
    nanovdb::Coord voxel_;
    real entered_ = 0.0f;  ///< where the ray comes into that voxel
};

}  // namespace opal
