// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/cell_field.h"

namespace opal {

/// Follows a ray from cell to cell by the published quadratic: |x - p_j| = |x - p_i| + D squared twice and solved as printed,
///   (A^2 - 4 D^2) t^2 + 2 (A B - 4 D^2 b) t + B^2 - 4 D^2 c = 0,
///   A = 2 v.s, B = 2 u.s + |s|^2 - D^2, u = o - p_i, b = u.v, c = |u|^2, s = p_i - p_j, D = w_j - w_i,
/// without the factored discriminant, whose digits cancel for weights that are nearly equal, and without the test that tells
/// the boundary's sheet of the hyperboloid from the other. The nearest root more than `epsilon_mm` ahead counts as a boundary;
/// who is beyond is asked of the sites, epsilon_mm farther on, so that a root of the other sheet costs time alone, while one that
/// is lost leaves the walk in a cell where it no longer is. Here to be compared: see CellWalk for what to use. Offers the same.
class HyperboloidWalk {
  public:
    static constexpr real epsilon_mm = 1.0e-4f;

    OPAL_HD HyperboloidWalk(const CellField& field, Vec3 origin, Vec3 direction, int cell = -1)
        : field_(field), origin_(origin), direction_(direction) {
        cell_ = locate_cell(field, origin, cell < 0 ? nearby_cell(field, origin) : cell);
    }

    OPAL_HD int next_grain(int current, real& distance, real end) {
        while (true) {
            const int grain = field_.grain[cell_];
            if (grain != current) return grain;
            const real exit_mm = find_exit(distance + epsilon_mm);
            if (!(exit_mm < end)) {
                distance = end;
                return 0;
            }
            distance = exit_mm;
            cell_ = locate_cell(field_, origin_ + (distance + epsilon_mm) * direction_, cell_);
        }
    }

    OPAL_HD int cell() const { return cell_; }

  private:
    OPAL_HD real find_exit(real after_mm) const {
        const CellSite site = field_.sites[cell_];
        const Vec3 u = origin_ - site.position();
        const real b = dot(u, direction_), c = dot(u, u);
        real exit_mm = 3.0e38f;
        for (uint32_t k = field_.first[cell_]; k < field_.first[cell_ + 1]; ++k) {
            const CellSite neighbor = field_.sites[field_.neighbors[k]];
            const Vec3 s = site.position() - neighbor.position();
            const real lead = neighbor.weight_mm - site.weight_mm, four_lead2 = 4.0f * lead * lead;
            const real a1 = 2.0f * dot(direction_, s), b1 = 2.0f * dot(u, s) + dot(s, s) - lead * lead;
            const real qa = a1 * a1 - four_lead2, qb = 2.0f * (a1 * b1 - four_lead2 * b), qc = b1 * b1 - four_lead2 * c;
            const real discriminant = qb * qb - 4.0f * qa * qc;
            if (!(discriminant >= 0.0f)) continue;
            const real root = sqrt(discriminant);
            const real roots_mm[2] = {(-qb - root) / (2.0f * qa), (-qb + root) / (2.0f * qa)};
            for (const real root_mm : roots_mm)
                if (root_mm > after_mm) exit_mm = min_of(exit_mm, root_mm);
        }
        return exit_mm;
    }

    const CellField& field_;
    Vec3 origin_, direction_;
    int cell_;
};

}  // namespace opal
