// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/upsampler.h"

#include <algorithm>
#include <cmath>

#include "renderer/host/sigmoid_table.h"

namespace opal {
namespace {

constexpr int resolution = sigmoid_table_resolution;
using Nodes = std::array<double, std::size_t(resolution)>;

constexpr Nodes nodes_of(double (*node)(int)) {
    Nodes nodes = {};
    for (int i = 0; i < resolution; ++i) nodes[std::size_t(i)] = node(i);
    return nodes;
}

constexpr Nodes ratio_nodes = nodes_of(sigmoid_table_ratio);
constexpr Nodes lightness_nodes = nodes_of(sigmoid_table_lightness);

/// Index of the cell that holds a value, and the value's place in it.
struct Cell {
    int index;
    double place;
};

Cell cell_of(const Nodes& nodes, double value) {
    const auto above = std::upper_bound(nodes.begin(), nodes.end(), value);
    return {std::clamp(static_cast<int>(above - nodes.begin()) - 1, 0, resolution - 2), 0.0};
}

Cell ratio_cell(double ratio) {
    Cell cell = cell_of(ratio_nodes, ratio);
    const double low = ratio_nodes[std::size_t(cell.index)], high = ratio_nodes[std::size_t(cell.index) + 1];
    cell.place = (ratio - low) / (high - low);
    return cell;
}

Cell lightness_cell(double lightness) {
    Cell cell = cell_of(lightness_nodes, lightness);
    const double low = sigmoid_table_coordinate(lightness_nodes[std::size_t(cell.index)]);
    const double high = sigmoid_table_coordinate(lightness_nodes[std::size_t(cell.index) + 1]);
    cell.place = (sigmoid_table_coordinate(lightness) - low) / (high - low);
    return cell;
}

/// So large that the sigmoid is 1 in single precision.
constexpr double saturated = 1.0e4;

float grey_coefficient(double value) {
    if (value <= 0.0) return float(-saturated);
    if (value >= 1.0) return float(saturated);
    return float(std::clamp((value - 0.5) / std::sqrt(value * (1.0 - value)), -saturated, saturated));
}

}  // namespace

UpsamplingMethod upsampling_method(Upsampling upsampling) {
    switch (upsampling) {
        case Upsampling::smits:
            return UpsamplingMethod::smits;
        case Upsampling::basis:
            return UpsamplingMethod::basis;
        case Upsampling::jakob_hanika:
            break;
    }
    return UpsamplingMethod::sigmoid;
}

std::array<float, 3> sigmoid_coefficients(Rgb color) {
    const std::array<double, 3> rgb = {double(color.r), double(color.g), double(color.b)};
    if (rgb[0] == rgb[1] && rgb[1] == rgb[2]) return {0.0f, 0.0f, grey_coefficient(rgb[0])};
    const std::size_t largest = std::size_t(std::max_element(rgb.begin(), rgb.end()) - rgb.begin());
    const Cell lightness = lightness_cell(rgb[largest]);
    const Cell first = ratio_cell(rgb[(largest + 1) % 3] / rgb[largest]);
    const Cell second = ratio_cell(rgb[(largest + 2) % 3] / rgb[largest]);
    const float* const table = sigmoid_table().data();
    std::array<double, 3> sum = {};
    for (int corner = 0; corner < 8; ++corner) {
        const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
        const double weight = (i ? first.place : 1.0 - first.place) * (j ? second.place : 1.0 - second.place) *
                              (k ? lightness.place : 1.0 - lightness.place);
        const int index = (int(largest) * resolution + lightness.index + k) * resolution + second.index + j;
        const float* const node = table + 3 * (std::size_t(index) * resolution + std::size_t(first.index + i));
        for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * double(node[c]);
    }
    return {float(sum[0]), float(sum[1]), float(sum[2])};
}

UpsampledColor upsample_reflectance(UpsamplingMethod method, Rgb color) {
    if (method != UpsamplingMethod::sigmoid) return {{float(color.r), float(color.g), float(color.b)}, 1.0f};
    const std::array<float, 3> c = sigmoid_coefficients(color);
    return {{c[0], c[1], c[2]}, 1.0f};
}

UpsampledColor upsample_radiance(UpsamplingMethod method, Rgb color) {
    const float scale = 2.0f * max_of(color.r, max_of(color.g, color.b));
    if (!(scale > 0.0f)) return {};
    UpsampledColor result = upsample_reflectance(method, {color.r / scale, color.g / scale, color.b / scale});
    result.scale = scale;
    return result;
}

}  // namespace opal
