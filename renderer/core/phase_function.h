// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/phase.h"
#include "renderer/core/phase_table.h"

namespace opal {

enum class PhaseKind { henyey_greenstein, draine, schlick, table };

/// One phase function of any kind.
struct PhaseFunctionView {
    PhaseKind kind = PhaseKind::henyey_greenstein;
    real g = 0.0f;      ///< Henyey-Greenstein's and Draine's g, Schlick's k; mean cosines: phase.h
    real alpha = 1.0f;  ///< Draine's second parameter
    PhaseTableView table;
};

/// True where the density differs from wavelength to wavelength: companions of a path then differ in it, too.
OPAL_HD inline bool phase_varies(const PhaseFunctionView& phase) {
    return phase.kind == PhaseKind::table;
}

/// Density per steradian of turning by an angle of the given cosine.
OPAL_HD inline real phase_density(const PhaseFunctionView& phase, real cosine, real wavelength_nm) {
    switch (phase.kind) {
        case PhaseKind::draine:
            return draine_phase(cosine, phase.g, phase.alpha);
        case PhaseKind::schlick:
            return schlick_phase(cosine, phase.g);
        case PhaseKind::table:
            return phase_table_density(phase.table, cosine, wavelength_nm);
        default:
            return henyey_greenstein_phase(cosine, phase.g);
    }
}

/// Draws the cosine with that density from two uniform numbers; kinds in closed form use the first alone.
OPAL_HD inline real sample_phase_cosine(const PhaseFunctionView& phase, real wavelength_nm, real u1, real u2) {
    switch (phase.kind) {
        case PhaseKind::draine:
            return sample_draine_cosine(u1, phase.g, phase.alpha);
        case PhaseKind::schlick:
            return sample_schlick_cosine(u1, phase.g);
        case PhaseKind::table:
            return sample_phase_table_cosine(phase.table, wavelength_nm, u1, u2);
        default:
            return sample_henyey_greenstein_cosine(u1, phase.g);
    }
}

}  // namespace opal
