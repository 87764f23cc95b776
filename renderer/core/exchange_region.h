// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/grain_path.h"

namespace opal {

/// Places x0 + a A + b B that light surely reaches inside one grain of one body as it goes back and forth between the directions
/// A and B (object space, mm). Neither a nor b ever shrinks, and the set is convex: where it holds the ends of the flights it
/// holds the flights.
///
/// It is the hull of x0 and of three places: how far it is safe to go along A, along B, and along both in equal parts. All four
/// are in the convex set of the places where every neighbour j of the cell i is behind. With CellWalk's
///   h_j(x) = (x - p_i).s + (|s|^2 - D^2) / 2 - D r(x),  r(x) = |x - p_i|,
/// positive in the cell, h_j is concave where D >= 0. Along a way v, r(x0 + t v) is below its chord over [0, T], so that h_j >=
/// h_j(x0) - t (D (r(x0 + T v) - r(x0)) / T - v.s). Where D < 0 the tangent of r at x0 is below r, and bounds h_j by a plane.
class ExchangeRegion {
  public:
    OPAL_HD ExchangeRegion(Vec3 a, Vec3 b) : ways_{a, b, a + b} {}

    /// No farther than `radius_mm` from the start.
    OPAL_HD void keep_in_ball(real radius_mm) {
        for (int w = 0; w < 3; ++w) per_mm_[w] = max_of(per_mm_[w], ball_per_mm(w, radius_mm));
    }

    /// No farther than the cell, nor than `size_mm` along A, B or A + B.
    OPAL_HD void keep_in_cell(const CellField& field, Vec3 place, int cell, real size_mm) {
        const CellSite site = field.sites[cell];
        const Vec3 offset = place - site.position();
        const real r_mm = length(offset);
        real chord[3], tangent[3];
        for (int w = 0; w < 3; ++w) {
            chord[w] = (length(offset + size_mm * ways_[w]) - r_mm) / size_mm;
            tangent[w] = r_mm > 0.0f ? dot(ways_[w], offset) / r_mm : 0.0f;
        }
        // As in CellWalk, blocks run on into the next site's neighbours, which does no harm.
        real steepest[3][OPAL_CELL_LANES] = {};
        for (uint32_t block = field.first[cell]; block < field.first[cell + 1]; block += OPAL_CELL_LANES) {
            real x[OPAL_CELL_LANES], y[OPAL_CELL_LANES], z[OPAL_CELL_LANES], weight_mm[OPAL_CELL_LANES];
            for (int lane = 0; lane < OPAL_CELL_LANES; ++lane) {
                const CellSite neighbor = field.sites[field.neighbors[block + lane]];
                x[lane] = neighbor.x;
                y[lane] = neighbor.y;
                z[lane] = neighbor.z;
                weight_mm[lane] = neighbor.weight_mm;
            }
            OPAL_SIMD
            for (int lane = 0; lane < OPAL_CELL_LANES; ++lane) {
                const real sx = site.x - x[lane], sy = site.y - y[lane], sz = site.z - z[lane];
                const real lead = weight_mm[lane] - site.weight_mm;
                const real tolerance = field.rounding_mm * (fabs(sx) + fabs(sy) + fabs(sz));
                const real behind = offset.x * sx + offset.y * sy + offset.z * sz +
                                    0.5f * (sx * sx + sy * sy + sz * sz - lead * lead) - lead * r_mm;
                const real margin = behind > tolerance ? behind - tolerance : 1.0e-20f;
                const real per_margin = 1.0f / (margin > 1.0e-20f ? margin : 1.0e-20f);
                // Ahead already: the place is in the neighbour's cell.
                const real least = behind < -tolerance ? 3.0e38f : 0.0f;
                for (int w = 0; w < 3; ++w) {
                    const real fall =
                        lead * (lead >= 0.0f ? chord[w] : tangent[w]) - (ways_[w].x * sx + ways_[w].y * sy + ways_[w].z * sz);
                    const real steepness = fall * per_margin;
                    const real bound = steepness > least ? steepness : least;
                    steepest[w][lane] = bound > steepest[w][lane] ? bound : steepest[w][lane];
                }
            }
        }
        for (int w = 0; w < 3; ++w) {
            per_mm_[w] = max_of(per_mm_[w], 1.0f / size_mm);
            for (int lane = 0; lane < OPAL_CELL_LANES; ++lane) per_mm_[w] = max_of(per_mm_[w], steepest[w][lane]);
        }
    }

    /// Whether it holds the place `a_mm` along A and `b_mm` along B from the start.
    OPAL_HD bool holds(real a_mm, real b_mm) const {
        const real both_mm = min_of(a_mm, b_mm);
        return max_of((a_mm - both_mm) * per_mm_[0], (b_mm - both_mm) * per_mm_[1]) + both_mm * per_mm_[2] < 1.0f;
    }

  private:
    OPAL_HD real ball_per_mm(int way, real radius_mm) const {
        const real speed = way < 2 ? 1.0f : length(ways_[2]);
        return radius_mm > 0.0f ? speed / radius_mm : 3.0e38f;
    }

    Vec3 ways_[3];
    real per_mm_[3] = {};  ///< one over how far it goes along each of the ways, in units of the way's vector
};

/// Where grains are cells, the cell as far as the grain's size; else the ball that is surely the grain's.
OPAL_HD inline void keep_in_grain(const GrainsView& grains, Vec3 place, int grain, int cell, real size_mm,
                                  ExchangeRegion& region) {
    if (grains.method != GrainMethod::voxels && cell >= 0 && grains.cells.grain[cell] == grain)
        region.keep_in_cell(grains.cells, place, cell, size_mm);
    else
        region.keep_in_ball(grain_clearance_mm(grains, place, grain, cell));
}

}  // namespace opal
