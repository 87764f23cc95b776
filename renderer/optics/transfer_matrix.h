// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace opal {

/// A homogeneous film.
struct Film {
    double thickness_nm;
    double permittivity;
};

enum class Polarization { s, p };

struct StackResponse {
    double reflectance;
    double transmittance;
};

/// Characteristic matrix of a stack of absorption-free films (Abeles 1950; Born & Wolf, section 1.6): ((a, i b), (i c, d)) with
/// real a, b, c, d even where the wave is evanescent, times exp(log_scale).
struct CharacteristicMatrix {
    double a = 1.0, b = 0.0, c = 0.0, d = 1.0;
    double log_scale = 0.0;

    /// This stack in front of `behind`.
    CharacteristicMatrix operator*(const CharacteristicMatrix& behind) const;
};

/// `tangential_index`: n sin(angle), which all films share.
CharacteristicMatrix characteristic_matrix(const Film& film, Polarization polarization, double wavelength_nm,
                                           double tangential_index);

/// `count` equal stacks one behind the other.
CharacteristicMatrix power(CharacteristicMatrix matrix, long count);

/// Reflected and transmitted part of the power of a plane wave that meets a stack from a half space of index `n_before` at
/// incidence cosine `cosine`; behind it, `n_behind`. Total internal reflection behind gives transmittance 0.
StackResponse stack_response(const CharacteristicMatrix& stack, Polarization polarization, double n_before, double n_behind,
                             double cosine);

}  // namespace opal
