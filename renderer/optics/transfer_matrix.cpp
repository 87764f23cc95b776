// SPDX-License-Identifier: Apache-2.0
#include "renderer/optics/transfer_matrix.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "formats/units.h"

namespace opal {

CharacteristicMatrix CharacteristicMatrix::operator*(const CharacteristicMatrix& behind) const {
    CharacteristicMatrix product{a * behind.a - b * behind.c, a * behind.b + b * behind.d, c * behind.a + d * behind.c,
                                 d * behind.d - c * behind.b, log_scale + behind.log_scale};
    // A thick stack inside its stop band grows exponentially: keep the numbers, not the size.
    const double largest = std::max({std::abs(product.a), std::abs(product.b), std::abs(product.c), std::abs(product.d)});
    if (largest > 1.0e100) {
        product = {product.a / largest, product.b / largest, product.c / largest, product.d / largest,
                   product.log_scale + std::log(largest)};
    }
    return product;
}

CharacteristicMatrix characteristic_matrix(const Film& film, Polarization polarization, double wavelength_nm,
                                           double tangential_index) {
    const double normal2 = film.permittivity - tangential_index * tangential_index;
    const double path = 2.0 * units::pi * film.thickness_nm / wavelength_nm;
    const double phase = path * std::sqrt(std::abs(normal2));
    const double cosine = normal2 >= 0.0 ? std::cos(phase) : std::cosh(phase);
    // sin(phase) / phase, or its evanescent counterpart.
    double sinc = 1.0;
    if (phase > 0.0) sinc = (normal2 >= 0.0 ? std::sin(phase) : std::sinh(phase)) / phase;
    if (polarization == Polarization::s) return {cosine, path * sinc, path * sinc * normal2, cosine, 0.0};
    return {cosine, path * sinc * normal2 / film.permittivity, path * sinc * film.permittivity, cosine, 0.0};
}

CharacteristicMatrix power(CharacteristicMatrix matrix, long count) {
    CharacteristicMatrix product;
    for (; count > 0; count /= 2) {
        if (count % 2 == 1) product = product * matrix;
        matrix = matrix * matrix;
    }
    return product;
}

StackResponse stack_response(const CharacteristicMatrix& stack, Polarization polarization, double n_before, double n_behind,
                             double cosine) {
    using Complex = std::complex<double>;
    const double sine = n_before * std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const Complex normal_behind = std::sqrt(Complex(n_behind * n_behind - sine * sine, 0.0));
    const bool is_s = polarization == Polarization::s;
    const double before = is_s ? n_before * cosine : n_before / cosine;
    const Complex behind = is_s ? normal_behind : n_behind * n_behind / normal_behind;
    const Complex i(0.0, 1.0);
    // Behind, an evanescent wave decays: its admittance is that of the root with positive imaginary part under exp(-i w t).
    const Complex field = stack.a - i * stack.b * behind, admittance = -i * stack.c + stack.d * behind;
    const Complex sum = before * field + admittance;
    return {std::norm((before * field - admittance) / sum),
            4.0 * before * behind.real() / std::norm(sum) * std::exp(-2.0 * stack.log_scale)};
}

}  // namespace opal
