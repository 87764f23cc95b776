// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/phase_function.h"
#include "renderer/host/phase_table.h"

namespace opal {

struct OpalConstants;

/// Owns a phase function: what its view points to.
struct PhaseFunction {
    PhaseKind kind = PhaseKind::henyey_greenstein;
    float g = 0.0f;
    float alpha = 1.0f;
    PhaseTable table;  ///< kind table alone

    PhaseFunctionView view() const { return {kind, g, alpha, table.view()}; }
};

/// Draine's g for a mean cosine in (-1, 1).
double draine_g(double mean_cosine, double alpha);
/// Schlick's k for a mean cosine in (-1, 1).
double schlick_k(double mean_cosine);

/// The phase function of what the constants call Mie scattering: mie_phase, with mie_asymmetry as its mean cosine in the closed
/// forms, or that of their particle. Throws InputError where make_mie_phase_table does.
PhaseFunction make_phase_function(const OpalConstants& constants);

}  // namespace opal
