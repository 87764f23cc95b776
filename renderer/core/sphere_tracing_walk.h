// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/cell_field.h"

namespace opal {

/// Follows a ray to the boundaries of cells by sphere tracing (Hart 1996): half the difference between the two smallest delta_i
/// is a distance within which no boundary lies, as each delta is 1-Lipschitz. The published way of rendering opal; here to be
/// compared. A boundary counts as reached where that distance is below `epsilon_mm`; the walk then goes on by epsilon_mm, in the
/// cell of the site that is nearest there. Stretches inside a cell shorter than that can be missed, and boundaries met at
/// grazing incidence take many steps. Offers what CellWalk does.
class SphereTracingWalk {
  public:
    static constexpr real epsilon_mm = 1.0e-4f;

    OPAL_HD SphereTracingWalk(const CellField& field, Vec3 origin, Vec3 direction, int cell = -1)
        : field_(field), origin_(origin), direction_(direction) {
        cell_ = locate_cell(field, origin, cell < 0 ? nearby_cell(field, origin) : cell);
    }

    OPAL_HD int next_grain(int current, real& distance, real end) {
        while (true) {
            const Vec3 position = origin_ + distance * direction_;
            cell_ = locate_cell(field_, position, cell_);
            const int grain = field_.grain[cell_];
            if (grain != current) return grain;
            distance += max_of(cell_clearance_mm(field_, position, cell_), epsilon_mm);
            if (!(distance < end)) {
                distance = end;
                return 0;
            }
        }
    }

    OPAL_HD int cell() const { return cell_; }

  private:
    const CellField& field_;
    Vec3 origin_, direction_;
    int cell_;
};

}  // namespace opal
