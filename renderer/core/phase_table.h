// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/vec.h"

namespace opal {

/// A phase function over cosine and wavelength: at each tabulated wavelength a piecewise linear density over the cosine, nodes
/// shared by all, denser where one of them bends; between two wavelengths the linear mixture of theirs.
struct PhaseTableView {
    const float* cosine = nullptr;   ///< nodes, from -1 to 1
    const float* density = nullptr;  ///< 1/sr at each node, wavelength after wavelength
    const float* cdf = nullptr;      ///< cumulative probability at each node, from 0 to 1, likewise
    int num_nodes = 0;
    int num_wavelengths = 0;
    real first_nm = 0.0f;
    real step_nm = 1.0f;
};

/// The two tabulated wavelengths around one, and how far it lies towards the second.
struct PhaseTableRows {
    int lower;
    real towards_upper;
};

OPAL_HD inline PhaseTableRows phase_table_rows(const PhaseTableView& table, real wavelength_nm) {
    const real last = real(table.num_wavelengths - 1);
    const real position = min_of(max_of((wavelength_nm - table.first_nm) / table.step_nm, 0.0f), last);
    const int lower = min_of(int(position), max_of(table.num_wavelengths - 2, 0));
    return {lower, position - real(lower)};
}

/// The last node whose entry is not above `value`, at most the second to last: start of the interval that holds it.
OPAL_HD inline int phase_table_interval(const float* entries, int count, real value) {
    int low = 0, high = count - 1;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        (entries[middle] <= value ? low : high) = middle;
    }
    return low;
}

/// Density per steradian.
OPAL_HD inline real phase_table_density(const PhaseTableView& table, real cosine, real wavelength_nm) {
    const PhaseTableRows rows = phase_table_rows(table, wavelength_nm);
    const int i = phase_table_interval(table.cosine, table.num_nodes, cosine);
    const real t = min_of(1.0f, max_of(0.0f, (cosine - table.cosine[i]) / (table.cosine[i + 1] - table.cosine[i])));
    const float* lower = table.density + size_t(rows.lower) * size_t(table.num_nodes) + i;
    const float* upper = rows.towards_upper > 0.0f ? lower + table.num_nodes : lower;
    return (1.0f - rows.towards_upper) * ((1.0f - t) * lower[0] + t * lower[1]) +
           rows.towards_upper * ((1.0f - t) * upper[0] + t * upper[1]);
}

/// Draws a cosine with exactly that density: u2 picks one of the two wavelengths by its share of the mixture, u1 is carried
/// through the inverse of that one's cumulative distribution, a quadratic within each interval.
OPAL_HD inline real sample_phase_table_cosine(const PhaseTableView& table, real wavelength_nm, real u1, real u2) {
    const PhaseTableRows rows = phase_table_rows(table, wavelength_nm);
    const size_t row = size_t(u2 < rows.towards_upper ? rows.lower + 1 : rows.lower) * size_t(table.num_nodes);
    const float* cdf = table.cdf + row;
    const int i = phase_table_interval(cdf, table.num_nodes, u1);
    const real mass = cdf[i + 1] - cdf[i];
    const real share = mass > 0.0f ? min_of(1.0f, (u1 - cdf[i]) / mass) : 0.5f;
    const real a = table.density[row + size_t(i)], b = table.density[row + size_t(i) + 1];
    // Root in [0, 1] of (b - a)/2 t^2 + a t = share (a + b)/2, in the form that does not cancel where a and b are close.
    const real t = share * (a + b) / max_of(1.0e-37f, a + sqrt(max_of(0.0f, a * a + share * (b - a) * (b + a))));
    return min_of(1.0f, table.cosine[i] + t * (table.cosine[i + 1] - table.cosine[i]));
}

}  // namespace opal
