// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stability_rows.h"

/// Where following light through the body degrades.
namespace opal {

/// A plate of 1 mm, index 1.5, that absorbs at the given optical depth and does not diffract: what passes at normal incidence,
/// over the closed form (1 - F)^2 a / (1 - F^2 a^2), a = exp(-depth).
Estimate plate_transmission_ratio(double optical_depth, int paths);

/// A ball of 6 mm that scatters all light (isotropic, no absorption) under uniform light of 1.
struct ScatteringBall {
    Estimate missing;          ///< of the light: 1 less what the picture shows
    Estimate truncated;        ///< energy that the render reports as cut off
    Estimate cut_off;          ///< share of the paths
    double scatterings = 0.0;  ///< per path
    double us_per_path = 0.0;  ///< processor time
};
/// `optical_depth` along the diameter.
ScatteringBall scattering_ball(double optical_depth, int max_bounces, int samples);

/// Flights through a ball whose scattering and absorption vary, with majorants changed by a factor.
struct MajorantEffect {
    Estimate error;       ///< what passes, relative to the integral, less 1
    Estimate violations;  ///< counted per flight
    double us_per_flight = 0.0;
};
MajorantEffect majorant_effect(double factor, int flights);

void add_depth_rows(bool quick, StabilityRows& rows);
void add_majorant_rows(bool quick, StabilityRows& rows);
void add_bounce_rows(bool quick, StabilityRows& rows);

}  // namespace opal
