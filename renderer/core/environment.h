// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/upsampling.h"

namespace opal {

/// Light from infinity: a latitude-longitude picture of colours of radiance (times the illuminant), top row at +Z, with the
/// tables that draw directions in proportion to their luminance.
struct EnvironmentView {
    const UpsampledColor* texels = nullptr;
    const float* row_cdf = nullptr;     ///< height + 1 values: which row
    const float* column_cdf = nullptr;  ///< height rows of width + 1 values: which column in the row
    int width = 0;
    int height = 0;
    real rotation_rad = 0.0f;  ///< counter-clockwise about +Z
};

OPAL_HD inline real wrap_unit(real x) {
    return x - floor(x);
}

/// Continuous texel coordinates of a direction: u in [0, 1) with longitude from +X counter-clockwise, v in [0, 1] from +Z down.
OPAL_HD inline void environment_uv(const EnvironmentView& environment, Vec3 direction, real& u, real& v) {
    u = wrap_unit((atan2(direction.y, direction.x) - environment.rotation_rad) * (0.5f / pi_f));
    v = acos(min_of(1.0f, max_of(-1.0f, direction.z))) * (1.0f / pi_f);
}

/// The four texels around a direction and their shares in it, bilinear between texel centres.
struct EnvironmentFootprint {
    const UpsampledColor* texel[4];
    real weight[4];
};

OPAL_HD inline EnvironmentFootprint environment_footprint(const EnvironmentView& environment, Vec3 direction) {
    real u, v;
    environment_uv(environment, direction, u, v);
    const real x = u * real(environment.width) - 0.5f, y = v * real(environment.height) - 0.5f;
    const int x0 = int(floor(x)), y0 = int(floor(y));
    const real tx = x - real(x0), ty = y - real(y0);
    const int columns[2] = {(x0 + environment.width) % environment.width, (x0 + 1) % environment.width};
    const int rows[2] = {max_of(y0, 0), min_of(y0 + 1, environment.height - 1)};
    EnvironmentFootprint footprint;
    for (int i = 0; i < 4; ++i) {
        footprint.texel[i] = environment.texels + size_t(rows[i / 2]) * size_t(environment.width) + columns[i % 2];
        footprint.weight[i] = (i % 2 ? tx : 1.0f - tx) * (i / 2 ? ty : 1.0f - ty);
    }
    return footprint;
}

/// Radiance over the illuminant's at one wavelength. The texels' spectra are mixed, not their colours or coefficients, so that
/// the picture stays linear in radiance.
OPAL_HD inline real environment_color(const SpectrumTables& tables, const EnvironmentFootprint& footprint, real wavelength_nm) {
    real sum = 0.0f;
    for (int i = 0; i < 4; ++i) sum += footprint.weight[i] * upsampled(tables, *footprint.texel[i], wavelength_nm);
    return sum;
}

/// Index of the interval of a cumulative table that holds u, and the position within it.
OPAL_HD inline int sample_cdf(const float* cdf, int count, real u, real& within) {
    int low = 0, high = count;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        (cdf[middle] <= u ? low : high) = middle;
    }
    within = min_of((u - cdf[low]) / (cdf[low + 1] - cdf[low]), 0.999999f);
    return low;
}

/// Probability density (1/sr) with which sample_environment draws a direction.
OPAL_HD inline real environment_pdf(const EnvironmentView& environment, Vec3 direction) {
    real u, v;
    environment_uv(environment, direction, u, v);
    const int column = min_of(int(u * real(environment.width)), environment.width - 1);
    const int row = min_of(int(v * real(environment.height)), environment.height - 1);
    const float* columns = environment.column_cdf + row * (environment.width + 1);
    const real density = (environment.row_cdf[row + 1] - environment.row_cdf[row]) * (columns[column + 1] - columns[column]) *
                         real(environment.width) * real(environment.height);
    const real sine = sqrt(direction.x * direction.x + direction.y * direction.y);
    return sine > 1.0e-6f ? density / (2.0f * pi_f * pi_f * sine) : 0.0f;
}

/// Draws a direction towards the environment.
OPAL_HD inline Vec3 sample_environment(const EnvironmentView& environment, real u1, real u2) {
    real within_row, within_column;
    const int row = sample_cdf(environment.row_cdf, environment.height, u1, within_row);
    const int column = sample_cdf(environment.column_cdf + row * (environment.width + 1), environment.width, u2, within_column);
    const real theta_rad = pi_f * (real(row) + within_row) / real(environment.height);
    const real phi_rad = 2.0f * pi_f * (real(column) + within_column) / real(environment.width) + environment.rotation_rad;
    const real sine = sin(theta_rad);
    return normalize({sine * cos(phi_rad), sine * sin(phi_rad), cos(theta_rad)});
}

}  // namespace opal
