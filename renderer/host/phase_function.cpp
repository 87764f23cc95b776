// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/phase_function.h"

#include "formats/opal_asset.h"

namespace opal {
namespace {

/// The parameter in (-1, 1) at which a mean cosine that grows with it takes a value, by bisection down to neighbouring doubles.
template <typename MeanCosine>
double parameter_of(const MeanCosine& mean_cosine, double value) {
    double low = -1.0, high = 1.0;
    for (double middle = 0.0; middle > low && middle < high; middle = 0.5 * (low + high))
        (mean_cosine(middle) < value ? low : high) = middle;
    return high;
}

}  // namespace

double draine_g(double mean_cosine, double alpha) {
    return parameter_of([alpha](double g) { return draine_mean_cosine(g, alpha); }, mean_cosine);
}

double schlick_k(double mean_cosine) {
    return parameter_of([](double k) { return schlick_mean_cosine(k); }, mean_cosine);
}

PhaseFunction make_phase_function(const OpalConstants& constants) {
    PhaseFunction phase;
    switch (constants.mie_phase) {
        case MiePhase::henyey_greenstein:
            phase.g = float(constants.mie_asymmetry);
            break;
        case MiePhase::draine:
            phase.kind = PhaseKind::draine;
            phase.g = float(draine_g(constants.mie_asymmetry, constants.draine_alpha));
            phase.alpha = float(constants.draine_alpha);
            break;
        case MiePhase::schlick:
            phase.kind = PhaseKind::schlick;
            phase.g = float(schlick_k(constants.mie_asymmetry));
            break;
        case MiePhase::lorenz_mie:
            phase.kind = PhaseKind::table;
            phase.table = make_mie_phase_table(crystal_defect(constants));
            break;
    }
    return phase;
}

}  // namespace opal
