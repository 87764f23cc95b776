// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/vec.h"

namespace opal {

/// The coefficients of the body that may vary, in the order of every array over them.
enum class MediumField { sigma_a_scale, sigma_s_rayleigh_400nm, sigma_s_mie };
inline constexpr int num_medium_fields = 3;

/// Bounds of every field over all that interpolation reads in a cell; both 1 for a field that does not vary.
struct MajorantCell {
    float min[num_medium_fields];
    float max[num_medium_fields];
};

/// A regular grid of cubes over the opal. What lies beyond it belongs to the nearest cell.
struct MajorantView {
    const MajorantCell* cells = nullptr;  ///< x fastest; null where no coefficient varies
    int size[3] = {0, 0, 0};
    Vec3 low_mm;  ///< object space
    real cells_per_mm = 0.0f;
};

/// Walks a ray from cell to cell (Amanatides & Woo 1987). Every exit distance follows from the cell's own faces, so that errors
/// do not add up.
class MajorantWalk {
  public:
    OPAL_HD MajorantWalk() {}

    /// `origin_mm` in object space; `step_mm`: how far the ray goes there (object mm) per unit of distance.
    OPAL_HD void start(const MajorantView& view, Vec3 origin_mm, Vec3 step_mm) {
        view_ = &view;
        const Vec3 origin = view.cells_per_mm * (origin_mm - view.low_mm), step = view.cells_per_mm * step_mm;
        const real origins[3] = {origin.x, origin.y, origin.z}, steps[3] = {step.x, step.y, step.z};
        for (int axis = 0; axis < 3; ++axis) {
            origin_[axis] = origins[axis];
            inverse_[axis] = 1.0f / steps[axis];
            forward_[axis] = steps[axis] > 0.0f ? 1 : (steps[axis] < 0.0f ? -1 : 0);
            cell_[axis] = int(min_of(max_of(floor(origins[axis]), 0.0f), real(view.size[axis] - 1)));
            find_exit(axis);
        }
    }

    OPAL_HD const MajorantCell& cell() const {
        return view_
            ->cells[(size_t(cell_[2]) * size_t(view_->size[1]) + size_t(cell_[1])) * size_t(view_->size[0]) + size_t(cell_[0])];
    }

    /// Distance at which the ray leaves the cell; beyond all distances in the last one.
    OPAL_HD real exit() const { return min_of(exit_[0], min_of(exit_[1], exit_[2])); }

    /// Goes on to the next cell.
    OPAL_HD void step() {
        const int axis = exit_[0] <= exit_[1] ? (exit_[0] <= exit_[2] ? 0 : 2) : (exit_[1] <= exit_[2] ? 1 : 2);
        cell_[axis] += forward_[axis];
        find_exit(axis);
    }

  private:
    OPAL_HD void find_exit(int axis) {
        const bool last = forward_[axis] > 0 ? cell_[axis] == view_->size[axis] - 1 : cell_[axis] == 0;
        const real face = real(forward_[axis] > 0 ? cell_[axis] + 1 : cell_[axis]);
        exit_[axis] = forward_[axis] == 0 || last ? 3.0e38f : (face - origin_[axis]) * inverse_[axis];
    }

    const MajorantView* view_;
    real origin_[3], inverse_[3], exit_[3];
    int forward_[3], cell_[3];
};

}  // namespace opal
