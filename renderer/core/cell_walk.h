// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/cell_field.h"

namespace opal {

/// Walks a ray from cell to cell of an additively weighted Voronoi diagram, exactly: each step is the first root of a quadratic
/// per neighbour. Sites of one grain that grew together are passed without notice. Offers what GrainWalk does.
///
/// In the cell of site i with weight w_i, at signed distance tau from the ray's foot (its place nearest to p_i, at e from p_i),
/// r = sqrt(tau^2 + |e|^2). For a neighbour j with s = p_i - p_j, D = w_j - w_i, a = v.s, gamma = e.s + (|s|^2 - D^2) / 2:
///   h(tau) = a tau + gamma - D r = (delta_j - delta_i) (|x - p_j| + r + D) / 2,
/// so that h has the sign of delta_j - delta_i, and the ray leaves towards j where h falls through 0:
///   tau = -(a gamma + D S) / P,  P = (a - D)(a + D),  S^2 = gamma^2 + |e|^2 P.
/// Of the two roots of (a tau + gamma)^2 = D^2 r^2 this one has h' = -S / r; it lies on the sheet that bounds the cell where
/// a < 0 (P > 0) or gamma D > 0 (P < 0). Measured from the foot, the discriminant is a sum that does not cancel as D -> 0.
///
/// Cells are star-shaped, not convex: a ray may come back into one, which the next cell's own neighbours tell.
///
/// Single precision. h errs by some roundings of the coordinates times |s|, and `tolerance` is a few times that. A neighbour that
/// is ahead by more than it takes over at once: a cell that was wrong by a hair, or altogether, is left for the right one. Such a
/// step lowers delta at the place where it is made, so there is an end to them. One that is ahead by less and gaining, or about
/// to be, takes over where h falls through -tolerance; all others where h falls through 0. These steps raise the distance,
/// through roots that depend on the two sites alone, so there is an end to them too: the walk cannot go round in circles. Where
/// neighbours tie (a ray along a boundary) the present cell is kept.
class CellWalk {
  public:
    /// `origin`, `direction` (unit length) in object space (mm). `cell`: one that holds the origin, or nearly; below 0: not
    /// known.
    OPAL_HD CellWalk(const CellField& field, Vec3 origin, Vec3 direction, int cell = -1)
        : field_(field), origin_(origin), direction_(direction), cell_(cell < 0 ? nearby_cell(field, origin) : cell) {}

    /// Goes on from `distance` to where a grain other than `current` begins, and returns it with `distance` set there. Returns 0
    /// with `distance` = `end` if there is none; may be asked again with an end farther away.
    OPAL_HD int next_grain(int current, real& distance, real end) {
        while (true) {
            if (!exit_known_) find_exit(distance);
            if (exit_mm_ <= distance) {  // not in this cell, or no longer
                enter_next();
                continue;
            }
            const int grain = field_.grain[cell_];
            if (grain != current) return grain;
            if (exit_mm_ >= end) {
                distance = end;
                return 0;
            }
            distance = exit_mm_;
            enter_next();
        }
    }

    /// Where the walk stands.
    OPAL_HD int cell() const { return cell_; }

  private:
    OPAL_HD void enter_next() {
        cell_ = next_cell_;
        exit_known_ = false;
    }

    /// What one cell and the ray have in common.
    struct Passage {
        CellSite site;
        Vec3 direction;   ///< of the ray
        Vec3 offset;      ///< e
        real offset2;     ///< |e|^2
        real offset_mm;   ///< |e|
        real foot_mm;     ///< distance of the foot along the ray
        real tau_mm;      ///< of the present place
        real r_mm;        ///< there
        real climb;       ///< dr/dtau there
        real present_mm;  ///< distance of the present place along the ray
        real rounding_mm;
    };

    /// Where the ray leaves the cell towards a neighbour; 3e38 where it does not. Free of branches.
    OPAL_HD static real exit_towards(const Passage& at, real x, real y, real z, real weight_mm) {
        const real sx = at.site.x - x, sy = at.site.y - y, sz = at.site.z - z;
        const real lead = weight_mm - at.site.weight_mm;
        const real tolerance = at.rounding_mm * (fabs(sx) + fabs(sy) + fabs(sz));
        const real a = at.direction.x * sx + at.direction.y * sy + at.direction.z * sz;
        const real exact_gamma =
            at.offset.x * sx + at.offset.y * sy + at.offset.z * sz + 0.5f * (sx * sx + sy * sy + sz * sz - lead * lead);
        const real h = a * at.tau_mm + exact_gamma - lead * at.r_mm;
        const bool sinks = a < lead * at.climb;
        const bool passed = h < (sinks ? -0.75f * tolerance : -tolerance);
        const real gamma = sinks & (h < 0.25f * tolerance) ? exact_gamma + tolerance : exact_gamma;

        const real p = (a - lead) * (a + lead);
        const real s2 = gamma * gamma + at.offset2 * p;
        const real ds = lead * sqrt(s2 > 0.0f ? s2 : 0.0f);
        const real ag = a * gamma;
        // The form of the root whose sum does not cancel.
        const bool same_sign = ag * ds >= 0.0f;
        const real numerator = same_sign ? ag + ds : (gamma - lead * at.offset_mm) * (gamma + lead * at.offset_mm);
        const real denominator = same_sign ? p : ag - ds;
        const real root_mm = at.foot_mm - numerator / denominator;
        const real sheet = p > 0.0f ? -a : gamma * lead;
        const bool leaves = (sheet > 0.0f) & (s2 >= 0.0f) & (root_mm > at.present_mm);
        const real exit_mm = leaves ? root_mm : 3.0e38f;
        return passed ? at.present_mm : exit_mm;
    }

    OPAL_HD void find_exit(real distance) {
        Passage at;
        at.site = field_.sites[cell_];
        at.direction = direction_;
        at.present_mm = distance;
        const Vec3 to_site = at.site.position() - origin_;
        at.foot_mm = dot(to_site, direction_);
        at.offset = at.foot_mm * direction_ - to_site;
        at.offset2 = dot(at.offset, at.offset);
        at.offset_mm = sqrt(at.offset2);
        at.tau_mm = distance - at.foot_mm;
        at.r_mm = sqrt(at.tau_mm * at.tau_mm + at.offset2);
        at.climb = at.r_mm > 0.0f ? at.tau_mm / at.r_mm : 0.0f;
        at.rounding_mm = field_.rounding_mm;

        // Blocks run on into the next site's neighbours: to ask about more sites than needed does no harm.
        const CellSite* sites = field_.sites;
        const uint32_t begin = field_.first[cell_], end = field_.first[cell_ + 1];
        real exit_mm = 3.0e38f;
        int next_cell = cell_;
        for (uint32_t block = begin; block < end; block += OPAL_CELL_LANES) {
            const int32_t* neighbors = field_.neighbors + block;
            real x[OPAL_CELL_LANES], y[OPAL_CELL_LANES], z[OPAL_CELL_LANES], weight_mm[OPAL_CELL_LANES];
            for (int lane = 0; lane < OPAL_CELL_LANES; ++lane) {
                const CellSite site = sites[neighbors[lane]];
                x[lane] = site.x;
                y[lane] = site.y;
                z[lane] = site.z;
                weight_mm[lane] = site.weight_mm;
            }
            real exits_mm[OPAL_CELL_LANES];
            OPAL_SIMD
            for (int lane = 0; lane < OPAL_CELL_LANES; ++lane)
                exits_mm[lane] = exit_towards(at, x[lane], y[lane], z[lane], weight_mm[lane]);
            for (int lane = 0; lane < OPAL_CELL_LANES; ++lane) {
                const bool sooner = exits_mm[lane] < exit_mm;
                exit_mm = sooner ? exits_mm[lane] : exit_mm;
                next_cell = sooner ? neighbors[lane] : next_cell;
            }
        }
        exit_mm_ = exit_mm;
        next_cell_ = next_cell;
        exit_known_ = true;
    }

    const CellField& field_;
    Vec3 origin_, direction_;
    int cell_;
    int next_cell_ = 0;
    real exit_mm_ = 0.0f;
    bool exit_known_ = false;
};

}  // namespace opal
