// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/environment.h"

/// Where light comes from inside a body, roughly: a histogram of directions in every cell of a coarse grid. Scattered light is
/// drawn in proportion to it times the phase function, with exact densities, so that its errors cost noise and never bias.
namespace opal {

/// Bins of equal solid angle: rows of equal height in z, columns of equal azimuth.
inline constexpr int guide_rows = 16, guide_columns = 32, guide_bins = guide_rows * guide_columns;
/// Nodes over the cosine of the body's phase function as guiding takes it.
inline constexpr int guide_phase_nodes = 64;

struct LightGuideView {
    const float* weight = nullptr;  ///< per cell a share of each bin, sum 1; x fastest; null: there is no guide
    Vec3 corner_mm;                 ///< world
    Vec3 cells_per_mm;
    int cells[3] = {0, 0, 0};
    real phase[guide_phase_nodes] = {};  ///< about the density of scattering (1/sr) over the cosine from -1 to 1; positive
};

OPAL_HD inline int guide_cell(const LightGuideView& guide, Vec3 position_mm) {
    const Vec3 from = position_mm - guide.corner_mm;
    const int x = max_of(0, min_of(guide.cells[0] - 1, int(from.x * guide.cells_per_mm.x)));
    const int y = max_of(0, min_of(guide.cells[1] - 1, int(from.y * guide.cells_per_mm.y)));
    const int z = max_of(0, min_of(guide.cells[2] - 1, int(from.z * guide.cells_per_mm.z)));
    return (z * guide.cells[1] + y) * guide.cells[0] + x;
}

OPAL_HD inline int guide_bin(Vec3 direction) {
    const int row = max_of(0, min_of(guide_rows - 1, int(0.5f * (direction.z + 1.0f) * real(guide_rows))));
    const real azimuth = wrap_unit(atan2(direction.y, direction.x) * (0.5f / pi_f));
    return row * guide_columns + min_of(guide_columns - 1, int(azimuth * real(guide_columns)));
}

/// The guide at one place for light that travels along one direction: each bin's share of the light times the phase function at
/// the bin's middle.
class GuidedDirections {
  public:
    OPAL_HD GuidedDirections(const LightGuideView& guide, Vec3 position_mm, Vec3 direction)
        : guide_(guide), weight_(guide.weight + size_t(guide_cell(guide, position_mm)) * guide_bins), direction_(direction) {
        for (int row = 0; row < guide_rows; ++row) {
            row_sum_[row] = 0.0f;
            visit_row(row, [&](int, real value) { row_sum_[row] += value; });
            total_ += row_sum_[row];
        }
    }

    /// False where the guide has nothing to say.
    OPAL_HD bool known() const { return total_ > 0.0f; }

    /// Density (1/sr) with which `sample` draws a direction.
    OPAL_HD real pdf(Vec3 direction) const {
        const int bin = guide_bin(direction);
        real value = 0.0f;
        visit_row(bin / guide_columns, [&](int column, real v) {
            if (column == bin % guide_columns) value = v;
        });
        return value / total_ * real(guide_bins) / (4.0f * pi_f);
    }

    OPAL_HD Vec3 sample(real u1, real u2) const {
        real rest = u1 * total_;
        int row = 0;
        while (row + 1 < guide_rows && rest >= row_sum_[row]) rest -= row_sum_[row++];
        int column = -1;
        real across = 0.0f;
        visit_row(row, [&](int c, real value) {
            if (column >= 0 || !(value > 0.0f)) return;
            if (rest < value) {
                column = c;
                across = rest / value;
            }
            rest -= value;
        });
        if (column < 0) return -direction_;  // rounding carried the number past the last bin
        const real z = -1.0f + 2.0f * (real(row) + u2) / real(guide_rows);
        const real azimuth_rad = 2.0f * pi_f * (real(column) + across) / real(guide_columns);
        const real sine = sqrt(max_of(0.0f, 1.0f - z * z));
        return normalize({sine * cos(azimuth_rad), sine * sin(azimuth_rad), z});
    }

  private:
    template <class Visit>
    OPAL_HD void visit_row(int row, const Visit& visit) const {
        const real z = -1.0f + 2.0f * (real(row) + 0.5f) / real(guide_rows), sine = sqrt(1.0f - z * z);
        const real along_z = direction_.z * z, along_x = direction_.x * sine, along_y = direction_.y * sine;
        // Middles of the columns by turning from one to the next.
        constexpr real turn_cos = 0.98078528f, turn_sin = 0.19509032f;  // 11.25 degrees
        real c = 0.99518473f, s = 0.09801714f;                          // 5.625 degrees
        for (int column = 0; column < guide_columns; ++column) {
            const real cosine = along_x * c + along_y * s + along_z;
            const int node = max_of(0, min_of(guide_phase_nodes - 1, int(0.5f * (cosine + 1.0f) * real(guide_phase_nodes))));
            visit(column, weight_[row * guide_columns + column] * guide_.phase[node]);
            const real next = c * turn_cos - s * turn_sin;
            s = s * turn_cos + c * turn_sin;
            c = next;
        }
    }

    const LightGuideView& guide_;
    const float* weight_;
    Vec3 direction_;
    real row_sum_[guide_rows];
    real total_ = 0.0f;
};

}  // namespace opal
