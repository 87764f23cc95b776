// SPDX-License-Identifier: Apache-2.0
#include "formats/colorimetry.h"

#include <algorithm>
#include <cmath>

#include "formats/cie_tables.h"

namespace opal {
namespace {

constexpr double determinant(const Matrix3& m) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

constexpr Matrix3 inverse(const Matrix3& m) {
    Matrix3 result = {};
    const double scale = 1.0 / determinant(m);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            result[i][j] = scale * (m[a][c] * m[b][d] - m[a][d] * m[b][c]);
        }
    return result;
}

constexpr Xyz transformed(const Matrix3& m, Xyz v) {
    return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
            m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

/// XYZ of the sRGB primaries, chromaticities of ITU-R BT.709, in the amounts that together are the white.
constexpr Matrix3 xyz_of_primaries() {
    constexpr double xy[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
    Matrix3 unscaled = {};
    for (std::size_t i = 0; i < 3; ++i) {
        unscaled[0][i] = xy[i][0] / xy[i][1];
        unscaled[1][i] = 1.0;
        unscaled[2][i] = (1.0 - xy[i][0] - xy[i][1]) / xy[i][1];
    }
    const Xyz amounts = transformed(inverse(unscaled), srgb_white);
    for (Matrix3::value_type& row : unscaled) row = {row[0] * amounts.x, row[1] * amounts.y, row[2] * amounts.z};
    return unscaled;
}

constexpr Matrix3 xyz_from_srgb = xyz_of_primaries();
constexpr Matrix3 srgb_from_xyz = inverse(xyz_from_srgb);

/// Cone-like responses of Lam and Rigg (Lam, PhD thesis, University of Bradford, 1985).
constexpr Matrix3 bradford = {{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};

double lab_response(double ratio) {
    constexpr double delta = 6.0 / 29.0;
    return ratio > delta * delta * delta ? std::cbrt(ratio) : ratio / (3.0 * delta * delta) + 4.0 / 29.0;
}

struct Uv {
    double u, v;
};

Uv uv_1960(Chromaticity c) {
    const double denominator = -2.0 * c.x + 12.0 * c.y + 3.0;
    return {4.0 * c.x / denominator, 6.0 * c.y / denominator};
}

Uv planckian_uv(double reciprocal_temperature) {
    std::array<double, colorimetric_samples> spectrum;
    for (int i = 0; i < colorimetric_samples; ++i)
        spectrum[std::size_t(i)] = planck_relative_to_560nm(colorimetric_min_nm + i, 1.0 / reciprocal_temperature);
    return uv_1960(chromaticity_of(xyz_of(spectrum)));
}

}  // namespace

double cie_d65_at(double wavelength_nm) {
    const double position = (wavelength_nm - 300.0) / 5.0;
    const std::size_t i = std::size_t(std::clamp(int(position), 0, 105));
    const double t = position - double(i);
    return (1.0 - t) * double(cie_d65_5nm[i]) + t * double(cie_d65_5nm[i + 1]);
}

double luminosity_integral_nm() {
    double sum = 0.0;
    for (const CieObserverRow& row : cie_1931_observer) sum += double(row.y);
    return sum;
}

Xyz xyz_of(std::span<const double, colorimetric_samples> spectrum) {
    Xyz sum = {0.0, 0.0, 0.0};
    double luminosity = 0.0;
    for (std::size_t i = 0; i < colorimetric_samples; ++i) {
        const CieObserverRow& row = cie_1931_observer[i];
        sum.x += spectrum[i] * double(row.x);
        sum.y += spectrum[i] * double(row.y);
        sum.z += spectrum[i] * double(row.z);
        luminosity += double(row.y);
    }
    return {sum.x / luminosity, sum.y / luminosity, sum.z / luminosity};
}

Xyz xyz_of_product(std::span<const double, colorimetric_samples> first, std::span<const double, colorimetric_samples> second) {
    std::array<double, colorimetric_samples> product;
    for (std::size_t i = 0; i < colorimetric_samples; ++i) product[i] = first[i] * second[i];
    return xyz_of(product);
}

Chromaticity chromaticity_of(Xyz color) {
    const double sum = color.x + color.y + color.z;
    return {color.x / sum, color.y / sum};
}

Rgb3d linear_srgb_from_xyz(Xyz color) {
    const Xyz v = transformed(srgb_from_xyz, color);
    return {v.x, v.y, v.z};
}

Xyz xyz_from_linear_srgb(Rgb3d color) {
    return transformed(xyz_from_srgb, {color.r, color.g, color.b});
}

double srgb_encoded(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

double srgb_decoded(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

Matrix3 bradford_adaptation(Xyz from, Xyz to) {
    const Xyz source = transformed(bradford, from), target = transformed(bradford, to);
    Matrix3 scaled = bradford;
    const double scale[3] = {target.x / source.x, target.y / source.y, target.z / source.z};
    for (std::size_t i = 0; i < 3; ++i)
        for (double& entry : scaled[i]) entry *= scale[i];
    constexpr Matrix3 back = inverse(bradford);
    Matrix3 result = {};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) result[i][j] += back[i][k] * scaled[k][j];
    return result;
}

Xyz operator*(const Matrix3& matrix, Xyz color) {
    return transformed(matrix, color);
}

Lab lab_from_xyz(Xyz color, Xyz white) {
    const double x = lab_response(color.x / white.x), y = lab_response(color.y / white.y), z = lab_response(color.z / white.z);
    return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

double delta_e_76(const Lab& a, const Lab& b) {
    return std::hypot(a.l - b.l, a.a - b.a, a.b - b.b);
}

double planck_relative_to_560nm(double wavelength_nm, double temperature_k) {
    constexpr double c2_nm_k = 1.438776877e7;
    const double ratio = 560.0 / wavelength_nm;
    return std::pow(ratio, 5.0) * std::expm1(c2_nm_k / (560.0 * temperature_k)) /
           std::expm1(c2_nm_k / (wavelength_nm * temperature_k));
}

CorrelatedColorTemperature correlated_color_temperature(Chromaticity chromaticity) {
    const Uv target = uv_1960(chromaticity);
    const auto distance = [&](double reciprocal) {
        const Uv uv = planckian_uv(reciprocal);
        return std::hypot(uv.u - target.u, uv.v - target.v);
    };
    // A coarse scan first: over the whole locus the distance need not have a single minimum.
    constexpr double low_limit = 1.0e-5, high_limit = 1.25e-3;
    constexpr int steps = 64;
    constexpr double step = (high_limit - low_limit) / steps;
    int nearest = 0;
    double least = distance(low_limit);
    for (int i = 1; i <= steps; ++i) {
        const double d = distance(low_limit + i * step);
        if (d < least) {
            least = d;
            nearest = i;
        }
    }
    double low = low_limit + std::max(0, nearest - 1) * step, high = low_limit + std::min(steps, nearest + 1) * step;
    constexpr double golden = 0.6180339887498949;
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double distance_a = distance(a), distance_b = distance(b);
    while (high - low > 1.0e-9 * high) {
        if (distance_a < distance_b) {
            high = b;
            b = a;
            distance_b = distance_a;
            a = high - golden * (high - low);
            distance_a = distance(a);
        } else {
            low = a;
            a = b;
            distance_a = distance_b;
            b = low + golden * (high - low);
            distance_b = distance(b);
        }
    }
    const double reciprocal = 0.5 * (low + high);
    const Uv foot = planckian_uv(reciprocal);
    const double sign = target.v >= foot.v ? 1.0 : -1.0;
    return {1.0 / reciprocal, sign * std::hypot(foot.u - target.u, foot.v - target.v)};
}

}  // namespace opal
