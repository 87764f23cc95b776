// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stability_rows.h"

/// Where coarse wavelengths lose narrow bands.
namespace opal {

enum class WavelengthChoice {
    fixed_48,    ///< the middles of the film's 48 layers alone
    layers_48,   ///< continuous wavelengths, the colour taken from the film's layers of 10 nm
    continuous,  ///< as the renderer draws them, one hero and three companions
};
const char* name_of(WavelengthChoice choice);

/// A box of `width_nm` that reflects all light of D65, at random places from 440 to 660 nm.
struct BandError {
    double energy_rms = 0.0;  ///< relative error of the luminance, root mean square over the places
    Estimate energy_mean;     ///< relative error of the luminance, mean over the places
    Estimate delta_e;         ///< CIEDE2000 of the band's colour shown with Y = 0.5 where it is right
};
/// `wavelengths`: drawn per place, of the continuous choice.
BandError band_error(WavelengthChoice choice, double width_nm, int places, int wavelengths);

void add_spectrum_rows(bool quick, StabilityRows& rows);

}  // namespace opal
