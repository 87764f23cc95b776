// SPDX-License-Identifier: Apache-2.0
// Computes the table of sigmoid_table.h while the project is built: generate_sigmoid_table OUTPUT.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "formats/cie_tables.h"
#include "formats/colorimetry.h"
#include "renderer/host/sigmoid_table.h"

namespace opal {
namespace {

using Vector3 = std::array<double, 3>;

/// Observer times D65 over the white's Y, and the wavelength on [0, 1], in steps of 1 nm.
struct Weights {
    std::array<double, colorimetric_samples> x, y, z, t;

    Weights() {
        double white_y = 0.0;
        for (std::size_t i = 0; i < colorimetric_samples; ++i) {
            const double light = cie_d65_at(colorimetric_min_nm + double(i));
            x[i] = light * double(cie_1931_observer[i].x);
            y[i] = light * double(cie_1931_observer[i].y);
            z[i] = light * double(cie_1931_observer[i].z);
            t[i] = double(i) / (colorimetric_samples - 1);
            white_y += y[i];
        }
        for (auto* channel : {&x, &y, &z})
            for (double& value : *channel) value /= white_y;
    }
};

/// XYZ under D65 of the reflectance with given coefficients, and its derivatives to them.
struct Evaluation {
    Vector3 xyz = {};
    Matrix3 derivative = {};  ///< [channel][coefficient]
};

Evaluation evaluate(const Weights& weights, const Vector3& c) {
    Evaluation result;
    for (std::size_t i = 0; i < colorimetric_samples; ++i) {
        const double t = weights.t[i];
        const double x = (c[0] * t + c[1]) * t + c[2];
        const double root = 1.0 / std::sqrt(1.0 + x * x);
        const double reflectance = 0.5 + 0.5 * x * root, slope = 0.5 * root * root * root;
        const double channel[3] = {weights.x[i], weights.y[i], weights.z[i]};
        for (std::size_t k = 0; k < 3; ++k) {
            result.xyz[k] += channel[k] * reflectance;
            const double step = channel[k] * slope;
            result.derivative[k][0] += step * t * t;
            result.derivative[k][1] += step * t;
            result.derivative[k][2] += step;
        }
    }
    return result;
}

double lab_slope(double ratio) {
    constexpr double delta = 6.0 / 29.0;
    return ratio > delta * delta * delta ? std::cbrt(ratio) / (3.0 * ratio) : 1.0 / (3.0 * delta * delta);
}

/// Lab minus the target and its derivatives to the coefficients.
struct Residual {
    Vector3 value;
    Matrix3 derivative;
    double square;
};

Residual residual_of(const Weights& weights, const Vector3& c, const Lab& target) {
    const Evaluation e = evaluate(weights, c);
    const Lab lab = lab_from_xyz({e.xyz[0], e.xyz[1], e.xyz[2]}, srgb_white);
    const Vector3 white = {srgb_white.x, srgb_white.y, srgb_white.z};
    Residual r;
    r.value = {lab.l - target.l, lab.a - target.a, lab.b - target.b};
    r.square = r.value[0] * r.value[0] + r.value[1] * r.value[1] + r.value[2] * r.value[2];
    for (std::size_t j = 0; j < 3; ++j) {
        Vector3 f;
        for (std::size_t k = 0; k < 3; ++k) f[k] = lab_slope(e.xyz[k] / white[k]) * e.derivative[k][j] / white[k];
        r.derivative[0][j] = 116.0 * f[1];
        r.derivative[1][j] = 500.0 * (f[0] - f[1]);
        r.derivative[2][j] = 200.0 * (f[1] - f[2]);
    }
    return r;
}

/// Solves (J^T J + damping diag(J^T J)) step = -J^T r by elimination of the symmetric 3x3 system.
Vector3 damped_step(const Residual& r, double damping) {
    double a[3][4] = {};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) a[i][j] += r.derivative[k][i] * r.derivative[k][j];
        for (std::size_t k = 0; k < 3; ++k) a[i][3] -= r.derivative[k][i] * r.value[k];
    }
    for (std::size_t i = 0; i < 3; ++i) a[i][i] *= 1.0 + damping;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t row = i + 1; row < 3; ++row) {
            const double factor = a[row][i] / a[i][i];
            for (std::size_t j = i; j < 4; ++j) a[row][j] -= factor * a[i][j];
        }
    Vector3 step;
    for (std::size_t i = 3; i-- > 0;) {
        step[i] = a[i][3];
        for (std::size_t j = i + 1; j < 3; ++j) step[i] -= a[i][j] * step[j];
        step[i] /= a[i][i];
    }
    return step;
}

/// Coefficients beyond this belong to colours at the edge of the cube, whose exact spectra would be steps; it keeps them finite
/// and the interpolation between nodes smooth.
constexpr double coefficient_limit = 1000.0;

/// Gauss-Newton with Levenberg's damping in CIE Lab, from the coefficients of a neighbouring colour.
void fit(const Weights& weights, Rgb3d color, Vector3& c) {
    const Lab target = lab_from_xyz(xyz_from_linear_srgb(color), srgb_white);
    Residual current = residual_of(weights, c, target);
    double damping = 1.0e-4;
    for (int iteration = 0; iteration < 60 && current.square > 1.0e-8 && damping < 1.0e8; ++iteration) {
        const Vector3 step = damped_step(current, damping);
        Vector3 next = c;
        double largest = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            next[i] += step[i];
            largest = std::max(largest, std::abs(next[i]));
        }
        if (!(largest < coefficient_limit)) {
            damping *= 8.0;
            continue;
        }
        const Residual candidate = residual_of(weights, next, target);
        if (candidate.square < current.square) {
            c = next;
            const bool stuck = candidate.square > 0.9999 * current.square;
            current = candidate;
            damping = std::max(1.0e-9, 0.1 * damping);
            if (stuck) break;
        } else {
            damping *= 8.0;
        }
    }
}

std::vector<float> computed_table() {
    const Weights weights;
    constexpr int n = sigmoid_table_resolution;
    std::vector<float> table(sigmoid_table_floats);
    for (int largest = 0; largest < 3; ++largest)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                // From a middling grey outwards, so that each colour starts at the solution of its neighbour.
                constexpr int start = n / 2;
                Vector3 middle = {0.0, 0.0, 0.0};
                const auto fill = [&](int k, Vector3& c) {
                    const double lightness = sigmoid_table_lightness(k);
                    double rgb[3];
                    rgb[largest] = lightness;
                    rgb[(largest + 1) % 3] = lightness * sigmoid_table_ratio(i);
                    rgb[(largest + 2) % 3] = lightness * sigmoid_table_ratio(j);
                    fit(weights, {rgb[0], rgb[1], rgb[2]}, c);
                    for (std::size_t coefficient = 0; coefficient < 3; ++coefficient)
                        table[std::size_t((((largest * n + k) * n + j) * n + i) * 3) + coefficient] = float(c[coefficient]);
                };
                fill(start, middle);
                Vector3 c = middle;
                for (int k = start + 1; k < n; ++k) fill(k, c);
                c = middle;
                for (int k = start - 1; k >= 0; --k) fill(k, c);
            }
    return table;
}

}  // namespace
}  // namespace opal

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: generate_sigmoid_table OUTPUT\n");
        return 2;
    }
    const std::vector<float> table = opal::computed_table();
    std::FILE* const file = std::fopen(argv[1], "wb");
    const bool written = file && std::fwrite(table.data(), sizeof(float), table.size(), file) == table.size();
    if (!file || std::fclose(file) != 0 || !written) {
        std::fprintf(stderr, "generate_sigmoid_table: %s: writing failed\n", argv[1]);
        return 1;
    }
    return 0;
}
