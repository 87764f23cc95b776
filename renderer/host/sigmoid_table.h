// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace opal {

/// Coefficients of sigmoid reflectances over the sRGB cube: the table of Jakob & Hanika 2019, "A low-dimensional function space
/// for efficient spectral upsampling", computed by generate_sigmoid_table.cpp while the project is built.
///
/// A colour is filed under its largest component l; the coordinates are that component's value, its lightness, and the ratios to
/// it of the components l + 1 and l + 2 modulo 3. Order: [largest][lightness][second ratio][first ratio][coefficient].
inline constexpr int sigmoid_table_resolution = 32;
inline constexpr int sigmoid_table_floats =
    3 * sigmoid_table_resolution * sigmoid_table_resolution * sigmoid_table_resolution * 3;

constexpr double smoothstep(double t) {
    return t * t * (3.0 - 2.0 * t);
}

/// Ratio of a node: denser at both ends, where Lab changes fastest (even spacing, as in the paper, needs twice the resolution for
/// the same error).
constexpr double sigmoid_table_ratio(int node) {
    return smoothstep(double(node) / (sigmoid_table_resolution - 1));
}

/// Lightness of a node: smoothstep applied twice, as in the paper.
constexpr double sigmoid_table_lightness(int node) {
    return smoothstep(sigmoid_table_ratio(node));
}

/// Where a lightness lies between two nodes is measured in this function of it, the inverse of the sigmoid: coefficients of
/// greys are linear in it, and those of other dark and bright colours nearly so. Bounded at the ends, beyond the first nodes.
double sigmoid_table_coordinate(double lightness);

/// The table, sigmoid_table_floats long.
std::span<const float, sigmoid_table_floats> sigmoid_table();

}  // namespace opal
