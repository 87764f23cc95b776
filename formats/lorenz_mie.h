// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <vector>

/// Scattering of a plane wave by a homogeneous sphere in a medium that does not absorb: the Lorenz-Mie series. Notation and
/// conventions of Bohren & Huffman, "Absorption and Scattering of Light by Small Particles", 1983, chapter 4: time factor
/// exp(-i omega t), so that an absorbing sphere has an index with a positive imaginary part.
namespace opal {

/// Coefficients a_n, b_n of the scattered field (B&H eq. 4.88); element n - 1 is order n.
struct MieCoefficients {
    double size_parameter = 0.0;
    std::vector<std::complex<double>> a, b;
};

/// Cross-sections over the sphere's geometric one, and the mean cosine of the scattering angle.
struct MieEfficiencies {
    double q_sca = 0.0;
    double q_ext = 0.0;
    double q_back = 0.0;     ///< 4 |S1(180 deg)|^2 / x^2
    double asymmetry = 0.0;  ///< g, the mean cosine
};

/// Amplitudes of the scattered field, polarized across (s1) and in (s2) the plane of scattering (B&H eq. 4.74).
struct MieAmplitudes {
    std::complex<double> s1, s2;
};

/// The coefficients of a sphere with size parameter x = pi diameter n_medium / (vacuum wavelength) and index relative to the
/// medium's. The series is cut where its terms fall below 1e-16: x + 7.1 x^(1/3) + 3 orders (B&H and Wiscombe, "Improved Mie
/// scattering algorithms", Appl. Opt. 19, 1980, stop near 4 x^(1/3), at terms of 1e-7). psi_n'/psi_n of the inside by downward
/// recurrence; psi_n of the outside upwards to order x and by its ratio beyond: stable at every size, checked up to x = 10,000.
/// Throws InputError for a size that is not in (0, 1e6], an index of which a part is negative or the real part 0, or above 100.
MieCoefficients mie_coefficients(double size_parameter, std::complex<double> relative_index);

/// Efficiencies and asymmetry: B&H eqs. 4.61, 4.62 and section 4.5.
MieEfficiencies mie_efficiencies(const MieCoefficients& coefficients);

/// Amplitudes at the cosine of a scattering angle, 1 forwards.
MieAmplitudes mie_amplitudes(const MieCoefficients& coefficients, double cosine);

/// Phase function for unpolarized light, 1/sr: (|S1|^2 + |S2|^2) / (2 pi x^2 Q_sca). Its integral over the sphere is 1.
double mie_phase_function(const MieCoefficients& coefficients, double q_sca, double cosine);

}  // namespace opal
