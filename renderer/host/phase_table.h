// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "formats/crystal_defect.h"
#include "renderer/core/phase_table.h"

namespace opal {

/// Owns a tabulated phase function.
struct PhaseTable {
    std::vector<float> cosine;
    std::vector<float> density;
    std::vector<float> cdf;
    int num_wavelengths = 0;
    float first_nm = 0.0f;
    float step_nm = 1.0f;

    PhaseTableView view() const;
    /// Mean cosine of the table at a wavelength.
    double mean_cosine(double wavelength_nm) const;
};

/// Wavelengths are tabulated every so many nanometres, from 360 to 830.
inline constexpr double phase_table_step_nm = 5.0;
/// At the tabulated wavelengths, nodes are added until the table differs from the series by less than this part of it between any
/// two nodes (of 1 % of an isotropic density where the series falls below that).
inline constexpr double phase_table_accuracy = 1.0e-3;

/// Lorenz-Mie phase functions of a defect of the crystal at every wavelength, normalized to rounding. Where the defect's index is
/// that of the crystal nothing scatters, and the table holds the limit of a vanishing contrast. The same bits on any number of
/// threads. Throws InputError where mie_coefficients does.
PhaseTable make_mie_phase_table(const CrystalDefect& defect);

}  // namespace opal
