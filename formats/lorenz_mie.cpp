// SPDX-License-Identifier: Apache-2.0
#include "formats/lorenz_mie.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/error.h"
#include "formats/units.h"

namespace opal {
namespace {

using Complex = std::complex<double>;

/// D_n(z) = psi_n'(z) / psi_n(z) for n = 0 to `orders`, by downward recurrence (B&H eq. 4.89). It starts at 0 so far above both
/// |z| and the orders asked for that the error of the start has died out.
template <typename Number>
std::vector<Number> logarithmic_derivatives(Number z, int orders) {
    const double size = std::abs(z);
    const int start = std::max(orders, static_cast<int>(size + 8.0 * std::cbrt(size))) + 16;
    std::vector<Number> derivatives(std::size_t(orders) + 1);
    Number d = 0.0;
    for (int n = start; n >= 1; --n) {
        if (n <= orders) derivatives[std::size_t(n)] = d;
        const Number ratio = double(n) / z;
        d = ratio - 1.0 / (d + ratio);
    }
    derivatives[0] = d;
    return derivatives;
}

void check(double size_parameter, Complex relative_index) {
    if (!(size_parameter > 0.0 && size_parameter <= 1.0e6))
        throw InputError(fmt::format("size parameter {:.6g} is out of range; allowed: above 0, to 1e6", size_parameter));
    const double real = relative_index.real(), imaginary = relative_index.imag();
    if (!(real > 0.0 && real <= 100.0 && imaginary >= 0.0 && imaginary <= 100.0))
        throw InputError(
            fmt::format("relative index {:.6g} + {:.6g} i is out of range; allowed: a real part above 0, to 100, an "
                        "imaginary one from 0 to 100",
                        real, imaginary));
}

}  // namespace

MieCoefficients mie_coefficients(double size_parameter, Complex relative_index) {
    check(size_parameter, relative_index);
    const double x = size_parameter;
    // Terms fall as Ai/Bi at 2^(1/3) (n - x) / x^(1/3) does: below 1e-16 from 7.1 x^(1/3) above x.
    const int orders = static_cast<int>(x + 7.1 * std::cbrt(x)) + 3;
    const std::vector<Complex> inside = logarithmic_derivatives(relative_index * x, orders);
    const std::vector<double> outside = logarithmic_derivatives(x, orders);

    MieCoefficients coefficients;
    coefficients.size_parameter = x;
    coefficients.a.reserve(std::size_t(orders));
    coefficients.b.reserve(std::size_t(orders));
    double psi_before = std::cos(x), psi = std::sin(x);
    double chi_before = -std::sin(x), chi = std::cos(x);
    for (int n = 1; n <= orders; ++n) {
        const double upward = (2.0 * n - 1.0) / x;
        // Above order x the upward recurrence of psi would lose all digits to chi's growth.
        const double psi_next = n <= x ? upward * psi - psi_before : psi / (n / x + outside[std::size_t(n)]);
        const double chi_next = upward * chi - chi_before;
        psi_before = psi;
        psi = psi_next;
        chi_before = chi;
        chi = chi_next;
        const Complex xi(psi, -chi), xi_before(psi_before, -chi_before);
        const Complex d = inside[std::size_t(n)];
        const Complex electric = d / relative_index + n / x;
        const Complex magnetic = d * relative_index + n / x;
        coefficients.a.push_back((electric * psi - psi_before) / (electric * xi - xi_before));
        coefficients.b.push_back((magnetic * psi - psi_before) / (magnetic * xi - xi_before));
    }
    return coefficients;
}

MieEfficiencies mie_efficiencies(const MieCoefficients& coefficients) {
    const auto& a = coefficients.a;
    const auto& b = coefficients.b;
    double scattered = 0.0, extinct = 0.0, forward = 0.0;
    Complex backward = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double n = double(i) + 1.0;
        scattered += (2.0 * n + 1.0) * (std::norm(a[i]) + std::norm(b[i]));
        extinct += (2.0 * n + 1.0) * (a[i] + b[i]).real();
        backward += (i % 2 == 0 ? -1.0 : 1.0) * (2.0 * n + 1.0) * (a[i] - b[i]);
        forward += (2.0 * n + 1.0) / (n * (n + 1.0)) * (a[i] * std::conj(b[i])).real();
        if (i + 1 < a.size())
            forward += n * (n + 2.0) / (n + 1.0) * (a[i] * std::conj(a[i + 1]) + b[i] * std::conj(b[i + 1])).real();
    }
    const double square = coefficients.size_parameter * coefficients.size_parameter;
    MieEfficiencies result;
    result.q_sca = 2.0 * scattered / square;
    result.q_ext = 2.0 * extinct / square;
    result.q_back = std::norm(backward) / square;
    result.asymmetry = scattered > 0.0 ? 2.0 * forward / scattered : 0.0;
    return result;
}

MieAmplitudes mie_amplitudes(const MieCoefficients& coefficients, double cosine) {
    MieAmplitudes amplitudes;
    double pi_before = 0.0, pi = 1.0;
    for (std::size_t i = 0; i < coefficients.a.size(); ++i) {
        const double n = double(i) + 1.0;
        const double tau = n * cosine * pi - (n + 1.0) * pi_before;
        const double weight = (2.0 * n + 1.0) / (n * (n + 1.0));
        amplitudes.s1 += weight * (coefficients.a[i] * pi + coefficients.b[i] * tau);
        amplitudes.s2 += weight * (coefficients.a[i] * tau + coefficients.b[i] * pi);
        const double pi_next = ((2.0 * n + 1.0) * cosine * pi - (n + 1.0) * pi_before) / n;
        pi_before = pi;
        pi = pi_next;
    }
    return amplitudes;
}

double mie_phase_function(const MieCoefficients& coefficients, double q_sca, double cosine) {
    const MieAmplitudes amplitudes = mie_amplitudes(coefficients, cosine);
    const double x = coefficients.size_parameter;
    return (std::norm(amplitudes.s1) + std::norm(amplitudes.s2)) / (2.0 * units::pi * x * x * q_sca);
}

}  // namespace opal
