// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stability_rows.h"

/// Where the models of diffraction degrade.
namespace opal {

/// What the Ewald rule reflects of white light at normal incidence on (111), spheres of 250 nm, 1.45 in 1.333.
struct EwaldBand {
    double energy_nm = 0.0;           ///< integral of the reflectance over the wavelength, in closed form
    double width_nm = 0.0;            ///< of the band in which it reflects
    double single_over_double = 0.0;  ///< energy found in single precision at even steps of the wavelength, over that
    double paths_per_turn = 0.0;      ///< wavelengths drawn evenly from 360 to 830 nm for one that is reflected
};
EwaldBand ewald_band(double tolerance, int wavelengths);
/// The same integral and width at half maximum of two-beam theory, for a grain of 1.5 mm in blocks of 25 um.
EwaldBand two_beam_band();

/// Light that meets (111) and (11-1) at 474 nm, near the edge of the zone where both are met at once.
struct ZoneEdge {
    double energy_error = 0.0;   ///< of the reflected energy, odds of the two families added, over three-beam theory's, less 1
    double largest_error = 0.0;  ///< of the reflectance at one wavelength
    int strong_families = 0;     ///< that reflect more than half each over a grain of 1.5 mm, at the wavelength of the first
};
/// `angle_rad` from the direction along which both have the same Bragg wavelength; one coherent block of `block_um`.
ZoneEdge zone_edge(double angle_rad, double block_um);

/// Of random directions and wavelengths (360 to 830 nm) along which at least one family reflects more than half over a grain of
/// 1.5 mm, the share along which two or more do.
Estimate multi_beam_share(double sphere_diameter_nm, int draws);

void add_ewald_rows(bool quick, StabilityRows& rows);
void add_zone_rows(bool quick, StabilityRows& rows);

}  // namespace opal
