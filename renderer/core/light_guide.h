// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/environment.h"

/// Where light comes from inside a body, roughly: a histogram of directions in every cell of a coarse grid. Scattered light is
/// drawn towards it, with exact densities, so that its errors cost noise and never bias.
namespace opal {

/// Bins of equal solid angle: rows of equal height in z, columns of equal azimuth.
inline constexpr int guide_rows = 16, guide_columns = 32, guide_bins = guide_rows * guide_columns;

struct LightGuideView {
    const float* cdf = nullptr;  ///< per cell guide_bins + 1 values, x fastest; null: there is no guide
    Vec3 corner_mm;              ///< world
    Vec3 cells_per_mm;
    int cells[3] = {0, 0, 0};
};

OPAL_HD inline int guide_cell(const LightGuideView& guide, Vec3 position_mm) {
    const Vec3 from = position_mm - guide.corner_mm;
    const int x = max_of(0, min_of(guide.cells[0] - 1, int(from.x * guide.cells_per_mm.x)));
    const int y = max_of(0, min_of(guide.cells[1] - 1, int(from.y * guide.cells_per_mm.y)));
    const int z = max_of(0, min_of(guide.cells[2] - 1, int(from.z * guide.cells_per_mm.z)));
    return (z * guide.cells[1] + y) * guide.cells[0] + x;
}

OPAL_HD inline int guide_bin(Vec3 direction) {
    const int row = max_of(0, min_of(guide_rows - 1, int(0.5f * (direction.z + 1.0f) * float(guide_rows))));
    const float azimuth = wrap_unit(atan2f(direction.y, direction.x) * (0.5f / pi_f));
    return row * guide_columns + min_of(guide_columns - 1, int(azimuth * float(guide_columns)));
}

/// Density (1/sr) with which sample_guide draws a direction.
OPAL_HD inline float guide_pdf(const LightGuideView& guide, Vec3 position_mm, Vec3 direction) {
    const float* cdf = guide.cdf + size_t(guide_cell(guide, position_mm)) * (guide_bins + 1);
    const int bin = guide_bin(direction);
    return (cdf[bin + 1] - cdf[bin]) * float(guide_bins) / (4.0f * pi_f);
}

/// A direction from which light comes.
OPAL_HD inline Vec3 sample_guide(const LightGuideView& guide, Vec3 position_mm, float u1, float u2) {
    float across;
    const int bin = sample_cdf(guide.cdf + size_t(guide_cell(guide, position_mm)) * (guide_bins + 1), guide_bins, u1, across);
    const float z = -1.0f + 2.0f * (float(bin / guide_columns) + u2) / float(guide_rows);
    const float azimuth_rad = 2.0f * pi_f * (float(bin % guide_columns) + across) / float(guide_columns);
    const float sine = sqrtf(max_of(0.0f, 1.0f - z * z));
    return normalize({sine * cosf(azimuth_rad), sine * sinf(azimuth_rad), z});
}

}  // namespace opal
